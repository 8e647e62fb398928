#!/usr/bin/python3
"""One loop of the demo: the blade cuts, threads draw the wound shut, the jaws tear it on, all is reset."""
import sys
import unittest

import rospy
import rostest
from robot_tissue.msg import TissueState

DEADLINE = 100.0  # s; a loop takes 41


class TestDemo(unittest.TestCase):
    def setUp(self):
        self.state = TissueState()
        self.by_blade = None  # springs, as the first thread is sewn
        self.both_bore = self.tore = False
        rospy.Subscriber("/robot_tissue/state", TissueState, self.take)
        self.end = rospy.Time.now() + rospy.Duration(DEADLINE)

    def take(self, state):
        self.state = state
        if state.sutures and self.by_blade is None:
            self.by_blade = state.springs_cut
        if self.by_blade is not None:
            self.both_bore = self.both_bore or sum(t > 0.0 for t in state.suture_tensions) == 2
            self.tore = self.tore or state.springs_cut > self.by_blade

    def wait_until(self, what, is_so):
        while not is_so(self.state):
            self.assertLess(rospy.Time.now(), self.end, f"within {DEADLINE:g} s: {what}")
            rospy.sleep(0.01)

    def test_cuts_sutures_tears_and_is_reset(self):
        self.wait_until("the block is whole", lambda state: state.pieces == 1 and state.springs_cut == 0)
        self.wait_until("the blade cuts", lambda state: state.springs_cut > 0)
        self.wait_until("two threads bear, and the wound tears on", lambda _: self.both_bore and self.tore)
        self.wait_until("it is reset", lambda state: state.springs_cut == 0 and not state.sutures)


if __name__ == "__main__":
    rospy.init_node("loop_of_demo")
    rostest.rosrun("robot_tissue", "loop_of_demo", TestDemo, sys.argv)
