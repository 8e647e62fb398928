"""A node under a master of its own, beside a robot of one sphere; for the studies of the node."""

import contextlib
import math
import os
import signal
import socket
import subprocess
import time
import xmlrpc.client
from pathlib import Path

import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

LAUNCH_FILE = Path(__file__).resolve().parent.parent.parent / "test/benchmark/node.launch"
PATIENCE = 20.0                 # s, until a process has ended by itself
TOP, RADIUS = 0.05, 0.01        # m, of the block and of the sphere
PRESS, ROUND = 0.005, 0.010     # m: depth, and radius of its way


class Robot:
    """Presses the sphere in, and goes round and round at an even speed."""

    def __init__(self, speed=0.0, frame="sphere", aside=0.0):
        self.speed = speed          # m/s
        self.frame, self.aside = frame, aside   # aside: along x (m)
        self.publisher = rospy.Publisher("/tf", TFMessage, queue_size=10)

    def place(self, gone):
        down = min(gone, 2 * PRESS)
        angle = (gone - down) / ROUND
        return (0.05 + self.aside + ROUND * math.cos(angle), 0.05 + ROUND * math.sin(angle),
                TOP + RADIUS + PRESS - down)

    def transform(self, gone):
        frame = TransformStamped()
        frame.header.stamp = rospy.Time.now()
        frame.header.frame_id, frame.child_frame_id = "tissue", self.frame
        shift = frame.transform.translation
        shift.x, shift.y, shift.z = self.place(gone)
        frame.transform.rotation.w = 1.0
        return frame

    def move(self, seconds, rate_hz, moves=True, gone=0.0):
        """Returns how far it went (m)."""
        start, sent = time.monotonic(), 0
        while time.monotonic() - start < seconds:
            if moves:
                gone += self.speed / rate_hz
            self.publisher.publish(TFMessage([self.transform(gone)]))
            sent += 1
            time.sleep(max(0.0, start + sent / rate_hz - time.monotonic()))
        return gone


def processor_seconds(pid):
    """Of each thread of the process, by its id; to the nanosecond."""
    seconds = {}
    for thread in Path(f"/proc/{pid}/task").iterdir():
        seconds[thread.name] = 1e-9 * int((thread / "schedstat").read_text().split()[0])
    return seconds


def free_port():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        return free.getsockname()[1]


def pid_of(node):
    """Of a node of this master, by its own answer."""
    uri = rospy.get_master().lookupNode(node)[2]
    return xmlrpc.client.ServerProxy(uri).getPid("/measuring")[2]


@contextlib.contextmanager
def running(command):
    process = subprocess.Popen(command)
    try:
        yield
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:   # what a shell starts in the background may ignore that signal
            process.terminate()
            process.wait()


@contextlib.contextmanager
def own_master(name):
    """With this process as one of its nodes."""
    port = str(free_port())
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    os.environ.setdefault("ROS_HOSTNAME", "localhost")
    with running(["rosmaster", "--core", "-p", port]):
        while True:
            try:
                rospy.get_master().getPid()
                break
            except OSError:
                time.sleep(0.2)
        rospy.init_node(name, anonymous=True, disable_signals=True)
        yield


def tissue_node(**arguments):
    """On a block of 4,851 nodes; arguments of its launch file."""
    told = [f"{name}:={value}" for name, value in arguments.items()]
    return running(["roslaunch", str(LAUNCH_FILE)] + told)
