#!/usr/bin/python3
"""The tool and the cut of play.launch, moved as the mouse in rviz does."""
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from robot_tissue.msg import TissueState
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray

DEADLINE = 25.0  # s
CUT, UNDO, RESET = 1, 2, 3  # entries of the menu


class TestPlay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_play")
        cls.last = {}
        for topic, kind in (("/robot_tissue/state", TissueState), ("/play/notes", MarkerArray),
                            ("/robot_tissue/sphere/measured_cf", WrenchStamped)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.last.update({topic: message}))
        rospy.wait_for_service("/robot_tissue/reset", DEADLINE)
        cls.feedback = rospy.Publisher("/play/feedback", InteractiveMarkerFeedback, queue_size=10)

    def until(self, holds, what):
        end = rospy.Time.now() + rospy.Duration(DEADLINE)
        while not holds() and rospy.Time.now() < end:
            rospy.sleep(0.02)
        self.assertTrue(holds(), what)

    def tell(self, marker, place=None, entry=None):
        self.until(lambda: self.feedback.get_num_connections() > 0 and self.note("message") != "",
                   "nobody hears of the markers")
        message = InteractiveMarkerFeedback(client_id="test", marker_name=marker)
        message.header.frame_id = "tissue"
        message.event_type = message.MENU_SELECT if entry else message.POSE_UPDATE
        message.menu_entry_id = entry or 0
        message.pose.orientation.w = 1.0
        if place:
            message.pose.position.x, message.pose.position.y, message.pose.position.z = place
        self.feedback.publish(message)

    def state(self):
        return self.last.get("/robot_tissue/state", TissueState(springs_cut=-1))

    def push(self):
        wrench = self.last.get("/robot_tissue/sphere/measured_cf")
        return wrench.wrench.force.z if wrench else 0.0

    def note(self, name):
        notes = self.last.get("/play/notes", MarkerArray())
        return next((marker.text for marker in notes.markers if marker.ns == name), "")

    # One after the other: the markers' server keeps one message at a time, and hears none while it
    # comes up.
    def reset(self):
        def is_done():
            self.tell("tool", entry=RESET)
            rospy.sleep(0.2)
            return "rest shape" in self.note("message")
        self.until(is_done, "no reset")
        self.until(lambda: self.state().springs_cut == 0, "cuts after a reset")

    def corner(self, number):
        notes = self.last.get("/play/notes", MarkerArray())
        points = next((marker.points for marker in notes.markers if marker.ns == "cut"), [])
        return (points[number].x, points[number].y, points[number].z) if points else None

    def shown_force(self):
        words = self.note("force").split()
        return float(words[0]) if len(words) > 1 and words[1].startswith("N") else 0.0

    def test_the_marker_moves_the_tool_into_the_tissue(self):
        self.tell("tool", (0.05, 0.05, 0.055))
        self.until(lambda: self.push() > 0.1, "the tissue does not answer")
        self.until(lambda: self.shown_force() > 0.1, "the force is not shown: " + self.note("force"))
        self.tell("tool", (0.05, 0.05, 0.085))
        self.until(lambda: self.push() == 0.0, "the tissue holds on")

    def test_the_menu_cuts_and_takes_back(self):
        self.reset()
        self.tell("corner_1", entry=CUT)
        self.until(lambda: self.state().springs_cut > 0, "no cut: " + self.note("message"))
        self.tell("tool", entry=UNDO)
        self.until(lambda: self.state().springs_cut == 0, "not taken back: " + self.note("message"))

    def test_a_cut_without_an_area_is_refused(self):
        self.reset()
        for number, corner in enumerate(("corner_1", "corner_2", "corner_3")):
            self.tell(corner, (0.05, 0.05, 0.05))
            self.until(lambda number=number: self.corner(number) == (0.05, 0.05, 0.05), "not moved")
        self.tell("tool", entry=CUT)
        self.until(lambda: "allowed" in self.note("message"), "not refused")
        self.assertEqual(self.state().springs_cut, 0)
        self.reset()

    def test_a_place_that_is_none_is_refused(self):
        self.tell("tool", (float("nan"), 0.0, 0.0))
        self.until(lambda: "allowed" in self.note("message"), "not refused")
        self.reset()


if __name__ == "__main__":
    rostest.rosrun("robot_tissue", "playing", TestPlay, sys.argv)
