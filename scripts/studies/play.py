"""Takes the picture of play.launch: a sphere pressed into the block, the cut's corners, in rviz.

On a display of its own, without a monitor. Needs the build's devel/setup.bash.
Out: doc/images/play.png.
"""

import math
import os
import sys
import time

import rospy
from geometry_msgs.msg import Point, Quaternion
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray

from studies import moved_node
from studies.common import IMAGES, PACKAGE, pyplot
from studies.screen import Screen

WIDTH, HEIGHT = 900, 600        # of the picture
CORNERS = {"corner_1": (0.0525, -0.012, 0.06), "corner_2": (0.0525, 0.03, 0.06),
           "corner_3": (0.0525, -0.012, 0.025)}
PRESSED = (0.035, 0.045, 0.052)  # m, middle of the sphere: 8 mm deep
LONGEST = 60.0                  # s, of one wait
DRAWN = 4.0                     # s, that rviz gets to draw what has come


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
            sys.exit(f"play: {name} did not come within {LONGEST:g} s")
        time.sleep(0.1)


def newtons(text):
    try:
        return float(text.split(" N")[0])
    except ValueError:
        return math.nan


def press(mouse):
    """As the picture shows it. Again and again: new markers listen to no one for a second."""
    def presses():
        for corner, place in CORNERS.items():
            mouse.move(corner, place)
        mouse.move("tool", PRESSED)
        return newtons(mouse.note("force")) > 0.1
    wait_for(presses, "a force")


def add_arguments(_):
    pass


def run(_):
    view = PACKAGE / "config/play.rviz"
    with moved_node.own_master("picture"), Screen(WIDTH, HEIGHT) as screen:
        os.environ.update(screen.environment)
        with moved_node.running(["roslaunch", "robot_tissue", "play.launch", "rviz:=false"]):
            mouse = Mouse()
            with moved_node.running(["rviz", "--fullscreen", "-d", str(view)]):
                press(mouse)
                time.sleep(DRAWN)
                pyplot().imsave(IMAGES / "play.png", screen.picture())
                print("force: " + mouse.note("force"))
