"""Takes the pictures of rviz: the demo, still and moving, play.launch, colors, the rim of a dragged dent.

On a display of its own, without a monitor, drawn by the processor. Needs the build's devel/setup.bash.
Out: doc/images/demo.gif, demo.png, play.png, color.png, dent.png.
"""

import contextlib
import math
import os
import sys
import tempfile
import time
from pathlib import Path

import rospy
import yaml
from geometry_msgs.msg import Point, Quaternion
from PIL import Image
from sensor_msgs.msg import JointState
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray

from studies import moved_node
from studies.common import IMAGES, PACKAGE
from studies.screen import Screen

WIDTH, HEIGHT = 1280, 800       # of the display
STILL = (900, 600)              # of a picture: the middle of the display, made smaller
MOVING = (480, 320)
FRAMES_PER_S = 6
LONGEST = 60.0                  # s, of one wait
DRAWN = 3.0                     # s, that rviz gets to draw what has come
SETTLED = 0.2                   # s, between looks at what moves
# Of the demo's trajectory (s): it presses, cuts, pulls beside the sutured cut, and tears it on.
DEMO_PERIOD = 40.9
DEMO_STILL = 25.2
DEMO_PARTS = [(3.5, 6.0), (11.5, 17.0), (23.0, 27.0), (33.0, 38.5)]
CORNERS = {"corner_1": (0.0525, -0.012, 0.06), "corner_2": (0.0525, 0.03, 0.06),
           "corner_3": (0.0525, -0.012, 0.025)}
DENT = {"Distance": 0.13, "Pitch": 0.55, "Focal Point": {"X": 0.055, "Y": 0.045, "Z": 0.05}}  # of the view, m, rad
DRAGGED = [(0.035 + 5e-4 * step, 0.045, 0.046) for step in range(61)]  # m, middle of the sphere: 14 mm deep
STEP = 0.05                     # s, between two of these places
PRESSED = (0.035, 0.045, 0.052)  # m, middle of the sphere: 8 mm deep


class Mouse:
    """Moves the markers of `play` and chooses from their menu, as rviz does."""

    def __init__(self):
        self._menu, self._notes = {}, {}
        rospy.Subscriber("/play/update_full", InteractiveMarkerInit, self._on_markers)
        rospy.Subscriber("/play/notes", MarkerArray, self._on_notes)
        self._feedback = rospy.Publisher("/play/feedback", InteractiveMarkerFeedback, queue_size=10)
        wait_for(lambda: self._menu and self._feedback.get_num_connections(), "play's markers")

    def _on_markers(self, init):
        self._menu = {entry.title: entry.id for marker in init.markers for entry in marker.menu_entries}

    def _on_notes(self, array):
        self._notes = {marker.ns: marker.text for marker in array.markers}

    def note(self, name):
        return self._notes.get(name, "")

    def move(self, marker, place, turn=(0.0, 0.0, 0.0, 1.0)):
        self._send(InteractiveMarkerFeedback.POSE_UPDATE, marker, place, turn)

    def choose(self, title):
        self._send(InteractiveMarkerFeedback.MENU_SELECT, "tool", entry=self._menu[title])

    def _send(self, kind, marker, place=(0, 0, 0), turn=(0, 0, 0, 1), entry=0):
        feedback = InteractiveMarkerFeedback(client_id="mouse", marker_name=marker, event_type=kind,
                                             menu_entry_id=entry)
        feedback.header.frame_id = "tissue"
        feedback.pose.position, feedback.pose.orientation = Point(*place), Quaternion(*turn)
        self._feedback.publish(feedback)


def wait_for(condition, name):
    end = time.monotonic() + LONGEST
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"screens: {name} did not come within {LONGEST:g} s")
        time.sleep(SETTLED)


def newtons(text):
    try:
        return float(text.split(" N")[0])
    except ValueError:
        return math.nan


def press(mouse, place=PRESSED):
    """As the picture shows it. Again and again: new markers listen to no one for a second."""
    def presses():
        for corner, at in CORNERS.items():
            mouse.move(corner, at)
        mouse.move("tool", place)
        return newtons(mouse.note("force")) > 0.05
    wait_for(presses, "a force")


def shot(screen, size):
    """The middle of the display, in the proportions of the size."""
    whole = Image.fromarray(screen.picture())
    width = min(WIDTH, HEIGHT * size[0] // size[1])
    left = (WIDTH - width) // 2
    return whole.crop((left, 0, left + width, HEIGHT)).resize(size, Image.LANCZOS)


def save(screen, name, folder):
    shot(screen, STILL).save(folder / name, optimize=True)
    print(folder / name, flush=True)


@contextlib.contextmanager
def shown(launch, view, *arguments):
    """What the launch file starts, and the view of it (a path, or a file in config) in all of the display."""
    if rospy.has_param("robot_description"):
        rospy.delete_param("robot_description")  # of an earlier one: rviz would show that robot
    with moved_node.running(["roslaunch", "robot_tissue", launch, *arguments]), \
            moved_node.running(["rviz", "--fullscreen", "-d", str(PACKAGE / "config" / view)]):
        yield


def take_play(screen, folder):
    with shown("play.launch", "play.rviz", "rviz:=false"):
        mouse = Mouse()
        press(mouse)
        time.sleep(DRAWN)
        save(screen, "play.png", folder)
        print("force: " + mouse.note("force"))


def take_color(screen, folder):
    with shown("play.launch", "play.rviz", "rviz:=false", "color:=strain"):
        press(Mouse())
        time.sleep(DRAWN)
        save(screen, "color.png", folder)


def near_view(folder):
    """That of play, from nearby and without the mouse's markers; its path."""
    view = yaml.safe_load((PACKAGE / "config/play.rviz").read_text())
    manager = view["Visualization Manager"]
    manager["Views"]["Current"].update(DENT)
    manager["Displays"] = [display for display in manager["Displays"] if display["Class"] != "rviz/InteractiveMarkers"]
    path = Path(folder) / "dent.rviz"
    path.write_text(yaml.safe_dump(view))
    return path


def take_dent(screen, folder):
    with tempfile.TemporaryDirectory() as place, shown("play.launch", near_view(place), "rviz:=false"):
        mouse = Mouse()
        press(mouse)
        for at in DRAGGED:
            mouse.move("tool", at)
            time.sleep(STEP)
        time.sleep(DRAWN)
        save(screen, "dent.png", folder)
        print("force: " + mouse.note("force"))


class Demo:
    """Where the demo's arm is on its trajectory, by its own clock."""

    def __init__(self):
        self._begin = None
        rospy.Subscriber("/joint_states", JointState, self._on_joints)

    def _on_joints(self, joints):
        if self._begin is None:
            self._begin = joints.header.stamp

    def time(self):
        return (rospy.Time.now() - self._begin).to_sec() if self._begin else 0.0

    def wait_until(self, seconds):
        while self.time() < seconds:
            time.sleep(0.005)


def take_demo(screen, folder):
    """The second round, as rviz comes up during the first."""
    demo, frames = Demo(), []
    with shown("demo.launch", "demo.rviz", "headless:=true"):
        for begin, end in DEMO_PARTS:
            for number in range(int((end - begin) * FRAMES_PER_S)):
                demo.wait_until(DEMO_PERIOD + begin + number / FRAMES_PER_S)
                frames.append(shot(screen, MOVING))
                if begin + number / FRAMES_PER_S <= DEMO_STILL < begin + (number + 1) / FRAMES_PER_S:
                    save(screen, "demo.png", folder)
    # Of an early one and the last: arrows, and the wound.
    both = Image.new("RGB", (MOVING[0], 2 * MOVING[1]))
    both.paste(frames[5], (0, 0))
    both.paste(frames[-1], (0, MOVING[1]))
    colors = both.quantize(128, method=Image.MAXCOVERAGE, dither=Image.NONE)
    few = [frame.quantize(palette=colors, dither=Image.NONE) for frame in frames]
    few[0].save(folder / "demo.gif", save_all=True, append_images=few[1:], loop=0, optimize=True,
                duration=1000 // FRAMES_PER_S)
    print(folder / "demo.gif", (folder / "demo.gif").stat().st_size // 1000, "kB", flush=True)


TAKES = {"play": take_play, "color": take_color, "dent": take_dent, "demo": take_demo}


def add_arguments(parser):
    parser.add_argument("--only", choices=TAKES, help="one of them")
    parser.add_argument("--folder", type=Path, default=IMAGES, help="where they are written")


def run(options):
    with moved_node.own_master("picture"), Screen(WIDTH, HEIGHT) as screen:
        os.environ.update(screen.environment)
        for name, take in TAKES.items():
            if options.only in (None, name):
                take(screen, options.folder)
