#!/usr/bin/python3
"""The demo's arm goes down until the tissue answers with the force that was asked for, and holds it; it draws back where
the wrenches' stamps stay old."""
import subprocess
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

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

    def test_it_draws_back_where_wrenches_stay_old(self):
        insertions = []
        rospy.Subscriber("/alone/joint_states", JointState,
                         lambda joints: insertions.append(dict(zip(joints.name, joints.position))["insertion_joint"]))
        topics = [rospy.Publisher(f"/alone/robot_tissue/{jaw}/measured_cf", WrenchStamped, queue_size=1)
                  for jaw in JAWS]

        def tell_until(condition, stamp):
            end = rospy.Time.now() + rospy.Duration(DEADLINE)
            while rospy.Time.now() < end and not condition():
                for topic in topics:  # no force, as of a tool that is clear
                    topic.publish(WrenchStamped(header=rospy.Header(stamp=stamp or rospy.Time.now())))
                rospy.sleep(0.01)
            self.assertTrue(condition(), f"after {DEADLINE:g} s the arm is at {insertions[-1:]}")

        tell_until(lambda: insertions and insertions[-1] > insertions[0] + 0.01, None)
        start, old = insertions[0], rospy.Time.now()
        tell_until(lambda: len(insertions) > 10 and insertions[-1] <= start + 1e-9, old)
        deepest = max(insertions)
        self.assertLess(deepest, start + 0.02, "m: it went on by what was told of long ago")
        seen = len(insertions)
        tell_until(lambda: len(insertions) > seen + 20, old)
        self.assertGreater(min(insertions), start - 1e-3, "m: no farther than it began")
        tell_until(lambda: insertions[-1] > start + 0.005, None)


if __name__ == "__main__":
    rospy.init_node("held_force")
    rostest.rosrun("robot_tissue", "held_force", TestAdmittance, sys.argv)
