#!/usr/bin/python3
"""The tools and the cut of play.launch, moved as the mouse in rviz does."""
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from robot_tissue.msg import TissueState
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray

DEADLINE = 25.0  # s
LOST = 1.0  # s: what did not show by then was not heard
HOME = (0.05, 0.05, 0.085)  # m, where a tool begins


def holds_within(seconds, condition):
    end = rospy.Time.now() + rospy.Duration(seconds)
    while not condition() and rospy.Time.now() < end:
        rospy.sleep(0.02)
    return condition()


class TestPlay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_play")
        cls.last = {}
        for topic, kind in (("/robot_tissue/state", TissueState), ("/play/notes", MarkerArray),
                            ("/play/update_full", InteractiveMarkerInit),
                            ("/robot_tissue/sphere/measured_cf", WrenchStamped)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.last.update({topic: message}))
        rospy.wait_for_service("/robot_tissue/reset", DEADLINE)
        cls.feedback = rospy.Publisher("/play/feedback", InteractiveMarkerFeedback, queue_size=10)

    def until(self, holds, what):
        self.assertTrue(holds_within(DEADLINE, holds), what)

    def tell(self, marker, place=None, entry=None):
        self.until(lambda: self.feedback.get_num_connections() > 0 and self.note("message") != ""
                   and self.menu(), "nobody hears of the markers")
        message = InteractiveMarkerFeedback(client_id="test", marker_name=marker)
        message.header.frame_id = "tissue"
        message.event_type = message.MENU_SELECT if entry else message.POSE_UPDATE
        message.menu_entry_id = self.menu()[entry] if entry else 0
        message.pose.orientation.w = 1.0
        if place:
            message.pose.position.x, message.pose.position.y, message.pose.position.z = place
        self.feedback.publish(message)

    def menu(self):
        """The number of each entry, by its title; the numbers come anew with the markers."""
        markers = self.last.get("/play/update_full", InteractiveMarkerInit()).markers
        return {each.title: each.id for marker in markers for each in marker.menu_entries}

    def state(self):
        return self.last.get("/robot_tissue/state", TissueState(springs_cut=-1))

    def push(self):
        wrench = self.last.get("/robot_tissue/sphere/measured_cf")
        return wrench.wrench.force.z if wrench else 0.0

    def note(self, name):
        notes = self.last.get("/play/notes", MarkerArray())
        return next((marker.text for marker in notes.markers if marker.ns == name), "")

    # The markers' server keeps one message at a time, and for about a second after markers were made
    # it hears none, and no menu: so all is told again and again, until it shows.
    def tell_until(self, holds, what, *told, **said):
        def is_so():
            self.tell(*told, **said)
            return holds_within(LOST, holds)
        self.until(lambda: holds() or is_so(), what + self.note("message"))

    def choose(self, entry, done):
        self.tell_until(lambda: done in self.note("message"), "no %s: " % entry, "tool", entry=entry)

    def reset(self):
        self.choose("Reset", "rest shape")
        self.until(lambda: self.state().springs_cut == 0, "cuts after a reset")

    def take(self, tool):
        self.choose("Take the " + tool, "the %s is at work" % tool)

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
        self.choose("Cut", "springs cut")
        self.until(lambda: self.state().springs_cut > 0, "no cut")
        self.tell_until(lambda: self.state().springs_cut == 0, "not taken back: ", "tool", entry="Undo")

    def test_a_cut_without_an_area_is_refused(self):
        self.reset()
        for number, corner in enumerate(("corner_1", "corner_2", "corner_3")):
            self.tell(corner, (0.05, 0.05, 0.05))
            self.until(lambda number=number: self.corner(number) == (0.05, 0.05, 0.05), "not moved")
        self.choose("Cut", "allowed")
        self.assertEqual(self.state().springs_cut, 0)
        self.reset()

    def test_a_place_that_is_none_is_refused(self):
        self.tell("tool", (float("nan"), 0.0, 0.0))
        self.until(lambda: "allowed" in self.note("message"), "not refused")
        self.reset()

    def test_what_was_saved_comes_back(self):
        self.reset()
        self.choose("Cut", "springs cut")
        self.until(lambda: self.state().springs_cut > 0, "no cut")
        cut = self.state().springs_cut
        self.choose("Save", "save_state")
        self.reset()
        self.choose("Load", "load_state")
        self.until(lambda: self.state().springs_cut == cut, "not as it was saved")
        self.reset()

    def test_the_knife_cuts_where_it_goes(self):
        self.reset()
        self.take("knife")
        self.assertEqual(self.state().springs_cut, 0)
        # Down and forward, between two planes of nodes.
        self.tell_until(lambda: self.state().springs_cut > 0, "the knife cuts nothing: ", "tool",
                        (0.0525, 0.03, 0.03))
        self.assertEqual(self.state().pieces, 1)
        self.tell("tool", HOME)
        self.take("sphere")
        self.reset()

    def test_the_forceps_hold_and_let_go(self):
        self.reset()
        self.take("forceps")
        self.tell("tool", (0.05, 0.05, 0.046))
        self.until(lambda: self.shown_force() > 0.1, "the open jaws do not press")
        self.choose("Open or close the forceps", "close")
        self.until(lambda: "forceps" in self.state().grasping, "the jaws hold nothing")
        self.choose("Open or close the forceps", "open")
        self.until(lambda: "forceps" not in self.state().grasping, "the jaws hold on")
        self.tell("tool", HOME)
        self.take("sphere")
        self.reset()

    def test_the_scissors_cut_what_is_between_them(self):
        self.reset()
        self.take("scissors")
        self.assertEqual(self.state().springs_cut, 0)
        # From above, between two planes of nodes.
        self.tell("tool", (0.0525, 0.05, 0.035))
        self.until(lambda: "scissors" in self.note("force"), "the scissors are not shown")
        self.choose("Open or close the scissors", "close")
        self.until(lambda: self.state().springs_cut > 0, "the scissors cut nothing")
        self.tell_until(lambda: self.state().springs_cut == 0, "not taken back: ", "tool", entry="Undo")
        self.choose("Open or close the scissors", "open")
        self.tell("tool", HOME)
        self.take("sphere")
        self.reset()

    def test_forceps_that_pull_harder_than_they_hold_tear_tissue_out(self):
        self.reset()
        self.take("forceps")
        self.tell("tool", (0.05, 0.05, 0.046))
        self.until(lambda: self.shown_force() > 0.1, "the open jaws do not press")
        self.choose("Open or close the forceps", "close")
        self.until(lambda: "forceps" in self.state().grasping, "the jaws hold nothing")
        self.tell_until(lambda: self.state().springs_cut > 0, "nothing tears: ", "tool", (0.05, 0.05, 0.1))
        self.assertGreater(self.state().pieces, 1)
        self.tell("tool", HOME)
        self.take("sphere")
        self.reset()


if __name__ == "__main__":
    rostest.rosrun("robot_tissue", "playing", TestPlay, sys.argv)
