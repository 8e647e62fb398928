#!/usr/bin/python3
"""The demo's arm goes down until the tissue answers with the force that was asked for, and holds it."""
import subprocess
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped

WANTED, OFF = 0.25, 0.01    # N
DEADLINE, HELD = 40.0, 1.0  # s
JAWS = "jaw_left", "jaw_right"


class TestAdmittance(unittest.TestCase):
    def setUp(self):
        self.pushes = {}
        for jaw in JAWS:
            rospy.Subscriber(f"/robot_tissue/{jaw}/measured_cf", WrenchStamped,
                             lambda wrench, jaw=jaw: self.pushes.update({jaw: -wrench.wrench.force.z}))

    def test_a_force_that_is_none_is_refused_in_a_line(self):
        for force in "abc", "-1", ".nan", "true":
            command = ["rosrun", "robot_tissue", "admittance", f"_force:={force}", "__name:=refused"]
            run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertRegex(run.stderr, r"\Aadmittance: parameter '/refused/force' = .*allowed: .*\n\Z")

    def test_the_force_comes_and_stays(self):
        end, since = rospy.Time.now() + rospy.Duration(DEADLINE), None
        while rospy.Time.now() < end:
            rospy.sleep(0.01)
            is_met = len(self.pushes) == len(JAWS) and abs(sum(self.pushes.values()) - WANTED) < OFF
            since = (since or rospy.Time.now()) if is_met else None
            if is_met and (rospy.Time.now() - since).to_sec() > HELD:
                return
        self.fail(f"after {DEADLINE:g} s the jaws push with {self.pushes}")


if __name__ == "__main__":
    rospy.init_node("held_force")
    rostest.rosrun("robot_tissue", "held_force", TestAdmittance, sys.argv)
