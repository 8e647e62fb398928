"""What play.launch shows: its tools, their interactive marker, the corners of a cut, notes."""

import math
from collections import namedtuple

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, Marker

FRAME = "tissue"
FARTHEST = 1.0  # m, of a marker from the tissue's origin
# m, of each tool's frame while another one is at work.
RACK = {"sphere": (-0.02, 0.17, 0.03), "probe": (0.03, 0.17, 0.02), "forceps": (0.08, 0.17, 0.02),
        "knife": (0.13, 0.19, 0.02), "scissors": (0.18, 0.17, 0.02)}
# m, in each tool's frame: middle of the ball that the mouse takes.
GRIP = {"sphere": (0.0, 0.0, 0.0), "probe": (0.0, 0.0, 0.065), "forceps": (0.0, 0.0, 0.06),
        "knife": (0.0, -0.025, 0.05), "scissors": (0.0, 0.0, 0.06)}
JAW_THICKNESS, HINGE = 0.004, 0.035  # m, as in play_tools.urdf: of the forceps; above the scissors' tip
RED = (0.85, 0.15, 0.15, 1)


class PoseError(ValueError):
    """A marker cannot be there; one line that says why."""


def pose_at(place):
    return Pose(position=Point(*place), orientation=Quaternion(w=1.0))


def checked_pose(feedback):
    """The pose of a marker that was moved, with a unit quaternion. Raises PoseError."""
    if feedback.header.frame_id not in ("", FRAME):
        raise PoseError("header.frame_id: '%s'; allowed: %s" % (feedback.header.frame_id, FRAME))
    place, turn = feedback.pose.position, feedback.pose.orientation
    # False of what is not a number, too.
    if not math.sqrt(place.x ** 2 + place.y ** 2 + place.z ** 2) <= FARTHEST:
        raise PoseError("position of %s: %g %g %g; allowed: within %g m of the tissue's origin"
                        % (feedback.marker_name, place.x, place.y, place.z, FARTHEST))
    length = math.sqrt(turn.x ** 2 + turn.y ** 2 + turn.z ** 2 + turn.w ** 2)
    if not 1e-3 < length < 1e3:
        raise PoseError("orientation of %s: length %g; allowed: a unit quaternion"
                        % (feedback.marker_name, length))
    return Pose(place, Quaternion(*(each / length for each in (turn.x, turn.y, turn.z, turn.w))))


def jaw_beside(side, gap):
    """Of the forceps: gap in m."""
    return pose_at((0.0, side * 0.5 * (gap + JAW_THICKNESS), 0.0))


def jaw_around_hinge(side, angle):
    """Of the scissors, around x: half the angle between the edges (rad); below 0 they have passed each other."""
    pose = pose_at((0.0, 0.0, HINGE))
    pose.orientation = Quaternion(math.sin(0.5 * side * angle), 0.0, 0.0, math.cos(0.5 * angle))
    return pose


# Of a tool with jaws: its links and their sides of the tool's y axis, what `pose` opens them to, per second.
Jaws = namedtuple("Jaws", "links open closed speed pose")
JAWS = {"forceps": Jaws({"left_jaw": 1.0, "right_jaw": -1.0}, 0.016, 0.003, 0.02, jaw_beside),
        "scissors": Jaws({"left_blade": 1.0, "right_blade": -1.0}, 0.35, -0.1, 1.0, jaw_around_hinge)}


def shape_marker(kind, size, color):
    return Marker(type=kind, scale=Vector3(*size), color=ColorRGBA(*color),
                  pose=Pose(orientation=Quaternion(w=1.0)))


def control(mode, orientation=(0.0, 0.0, 0.0, 1.0), markers=()):
    made = InteractiveMarkerControl(interaction_mode=mode, always_visible=bool(markers))
    made.orientation = Quaternion(*orientation)
    made.markers = list(markers)
    return made


def tool_marker(tool, pose):
    """Six degrees of freedom along the tool's own axes, and a ball that moves in the plane of the view."""
    marker = InteractiveMarker(name="tool", pose=pose, scale=0.075)
    marker.header.frame_id = FRAME
    half = math.sqrt(0.5)
    for axis in ((half, 0.0, 0.0, half), (0.0, half, 0.0, half), (0.0, 0.0, half, half)):
        marker.controls.append(control(InteractiveMarkerControl.MOVE_AXIS, axis))
        marker.controls.append(control(InteractiveMarkerControl.ROTATE_AXIS, axis))
    ball = shape_marker(Marker.SPHERE, (0.022, 0.022, 0.022), (0.3, 0.6, 1, 0.4))
    ball.pose.position = Point(*GRIP[tool])
    marker.controls.append(control(InteractiveMarkerControl.MOVE_3D, markers=[ball]))
    return marker


def corner_marker(name, place):
    marker = InteractiveMarker(name=name, pose=pose_at(place), scale=0.02)
    marker.header.frame_id = FRAME
    ball = shape_marker(Marker.SPHERE, (0.007, 0.007, 0.007), RED)
    marker.controls.append(control(InteractiveMarkerControl.MOVE_3D, markers=[ball]))
    return marker


def note(name, kind, size, color):
    made = shape_marker(kind, size, color)
    made.ns = name
    made.header.frame_id = FRAME
    return made
