#!/usr/bin/python3
"""Two hosts, each in a network of its own, and a link between them that goes for five seconds: the node tells that
the robot's poses are stale, keeps the last good shape, and follows again when the link is back.

usage: lost_link.py NODE [--gtest_output=xml:FILE]. Skipped where networks may not be made.
"""
import os
import subprocess
import sys
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
NODE_HOST, ROBOT_HOST, AWAY = "10.77.0.1", "10.77.0.2", 5.0     # s
ROBOT = """
import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage
rospy.init_node("robot", disable_signals=True)
topic = rospy.Publisher("/tf", TFMessage, queue_size=10)
while True:
    tip = TransformStamped()
    tip.header.stamp = rospy.Time.now()
    tip.header.frame_id, tip.child_frame_id = "tissue", "probe"
    tip.transform.translation.x = tip.transform.translation.y = 0.05
    tip.transform.translation.z = 0.055
    tip.transform.rotation.w = 1.0
    topic.publish(TFMessage([tip]))
    rospy.sleep(0.02)
"""


def may_make_networks():
    made = subprocess.run(["unshare", "-n", "ip", "link", "add", "name", "v0", "type", "veth", "peer", "name", "v1"],
                          capture_output=True)
    return made.returncode == 0


def ip(*words, of=None):
    inside = ["nsenter", "-t", str(of), "-n"] if of else []
    subprocess.run([*inside, "ip", *words], check=True)


class LostLink(unittest.TestCase):
    def start(self, command, host, of=None):
        inside = ["nsenter", "-t", str(of), "-n"] if of else []
        process = subprocess.Popen([*inside, *command], env={**os.environ, "ROS_IP": host})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def connect(self):
        other = subprocess.Popen(["unshare", "-n", "sleep", "600"])
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)
        own = os.readlink("/proc/self/ns/net")
        while os.readlink(f"/proc/{other.pid}/ns/net") == own:
            time.sleep(0.05)
        ip("link", "set", "lo", "up")
        ip("link", "add", "name", "v0", "type", "veth", "peer", "name", "v1")
        ip("link", "set", "v1", "netns", str(other.pid))
        for name, address, of in (("v0", NODE_HOST, None), ("v1", ROBOT_HOST, other.pid)):
            ip("addr", "add", address + "/24", "dev", name, of=of)
            ip("link", "set", name, "up", of=of)
        return other.pid

    def wait_for(self, condition, seconds=40.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end and not condition():
            time.sleep(0.05)
        return condition()

    def test_node_goes_on_after_it(self):
        robot_host = self.connect()
        os.environ.update(ROS_MASTER_URI=f"http://{NODE_HOST}:11311", ROS_IP=NODE_HOST)
        os.environ.pop("ROS_HOSTNAME", None)
        import rospy
        from robot_tissue.msg import TissueState
        self.start(["rosmaster", "--core", "-p", "11311"], NODE_HOST)
        self.assertTrue(self.wait_for(lambda: subprocess.run(
            ["rosparam", "set", "-t", str(HERE / "probe.urdf"), "/robot_description"],
            capture_output=True).returncode == 0))
        subprocess.run(["rosparam", "load", str(HERE / "scene.yaml"), "/tissue"], check=True)
        self.start([sys.argv[1], "__name:=tissue"], NODE_HOST)
        self.start([sys.executable, "-c", ROBOT], ROBOT_HOST, of=robot_host)
        rospy.init_node("lost_link", disable_signals=True)
        states = []
        kept = rospy.Subscriber("/tissue/state", TissueState, states.append)
        self.assertTrue(self.wait_for(lambda: states and states[-1].status == "OK" and
                                      states[-1].force_of_tools.z < -0.01))
        pressed = states[-1].volume_ratio
        ip("link", "set", "v0", "down")
        lost_at = time.monotonic()
        self.assertTrue(self.wait_for(lambda: states[-1].status == "STALE", AWAY))
        self.assertEqual(states[-1].volume_ratio, pressed)  # the last good shape
        time.sleep(max(0.0, lost_at + AWAY - time.monotonic()))
        ip("link", "set", "v0", "up")
        self.assertTrue(self.wait_for(lambda: states[-1].status == "OK"), states[-1].status)
        self.assertTrue(kept)


if __name__ == "__main__":
    if "--inside" not in sys.argv and may_make_networks():
        os.execvp("unshare", ["unshare", "-n", sys.executable, *sys.argv, "--inside"])
    if "--inside" in sys.argv:
        sys.argv.remove("--inside")
    else:
        LostLink = unittest.skip("no network of its own may be made here")(LostLink)
    import rosunit
    rosunit.unitrun("robot_tissue", "lost_link", LostLink, [sys.argv[0], *sys.argv[2:]])
