#!/usr/bin/python3
"""A client of the soak, a process of its own: soak_client.py ROLE NODE_PID. Each line that it prints is one of
JSON: what it saw since the line before. It goes with its input."""

import json
import math
import os
import random
import sys
import threading
import time
from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, Vector3, WrenchStamped
from robot_tissue.msg import ContactArray, Surface, TissueState
from robot_tissue.srv import ApplyLoad, ApplyLoadRequest, Cut, CutRequest
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

LONGEST = 5.0      # s: a reply that takes longer is missed
TIDY = 2.5         # s after a reset: the node has given back what it does not use, and told its heap since
HEAP, DUE = "heap in use (MB)", "poses (Hz)"    # keys of the node's diagnostics
NODE = "/robot_tissue/"


def memory_of(pid):
    """MB that it has in memory."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return 1e-6 * pages * os.sysconf("SC_PAGE_SIZE")


class Seen:
    """Sums since they were last told."""

    def __init__(self):
        self.lock = threading.Lock()
        self.values = {}

    def add(self, name, value=1):
        with self.lock:
            self.values[name] = self.values.get(name, 0) + value

    def most(self, name, value):
        with self.lock:
            self.values[name] = max(self.values.get(name, 0.0), value)

    def tell(self):
        with self.lock:
            values, self.values = self.values, {}
        print(json.dumps(values), flush=True)


def count(seen, topic, kind, numbers):
    """Counts a topic's messages, and the numbers in them that are not finite."""
    def take(message):
        seen.add(topic)
        bad = sum(not math.isfinite(number) for number in numbers(message))
        if bad:
            seen.add("not_finite", bad)
    name = topic if topic.startswith("/") else NODE + topic
    return rospy.Subscriber(name, kind, take, queue_size=100, tcp_nodelay=True)


def wrench_numbers(message):
    force, torque = message.wrench.force, message.wrench.torque
    return force.x, force.y, force.z, torque.x, torque.y, torque.z


def stages(seen, message):
    """Sums of what an update's parts took."""
    for stage in ("contact_ms", "solve_ms", "publish_ms"):
        seen.add(stage, getattr(message, stage))
    return message.residual, message.volume_ratio, message.unbalanced_force, *message.suture_tensions


def diagnosed(message, key):
    """Numbers of that key; the node tells them once a second."""
    return [float(value.value) for status in message.status for value in status.values if value.key == key]


def due_poses(seen, message):
    """What the node itself counts: poses that were due, followed or missed."""
    seen.add("due", sum(diagnosed(message, DUE)))
    return ()


def contact_numbers(message):
    return [number for contact in message.contacts for number in (contact.depth, contact.force.z)]


def surface_numbers(message):
    return [number for vertex in message.vertices for number in (vertex.x, vertex.y, vertex.z)]


def called(seen, name, kind, request):
    """A reply that does not come, or not in time, is missed; one that refuses is none."""
    start = time.monotonic()
    seen.add("calls")
    try:
        reply = rospy.ServiceProxy(NODE + name, kind)(request) if request else \
            rospy.ServiceProxy(NODE + name, kind)()
    except rospy.ServiceException:
        seen.add("missed")
        return
    took = time.monotonic() - start
    seen.most("slowest_reply_ms", 1e3 * took)
    if took > LONGEST:
        seen.add("missed")
    if not reply.success:
        seen.add("refused")


def cut_request(rng):
    """Straight down, 20 mm deep, somewhere in the block."""
    along, x, y = rng.uniform(0.0, math.pi), rng.uniform(0.03, 0.07), rng.uniform(0.03, 0.07)
    half = rng.uniform(0.008, 0.02)
    dx, dy = half * math.cos(along), half * math.sin(along)
    corners = [(x - dx, y - dy, 0.03), (x + dx, y + dy, 0.03), (x + dx, y + dy, 0.07), (x - dx, y - dy, 0.07)]
    return CutRequest(corners=[Point(*corner) for corner in corners])


def surgeon(seen, node_pid):
    """Cuts and takes back, and all anew once a minute or so, when it looks at the node's memory."""
    rng = random.Random(22)
    heap = []
    kept = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: heap.extend(diagnosed(message, HEAP)))
    assert kept
    for turn in range(10 ** 9):
        for _ in range(2):
            called(seen, "cut", Cut, cut_request(rng))
            time.sleep(2.0)
        for _ in range(2):
            called(seen, "undo", Trigger, None)
            time.sleep(2.0)
        if turn % 8 == 7:
            called(seen, "reset", Trigger, None)
            time.sleep(TIDY)
            seen.most("rest_memory_MB", memory_of(node_pid))
            seen.most("rest_heap_MB", heap[-1])
            heap.clear()


def load_request(depth):
    """Pulls at a corner; without a depth lets go."""
    wanted = ApplyLoadRequest(name="corner", min=Point(-1, -1, 0.05), max=Point(0.012, 0.012, 0.05))
    if depth:
        wanted.displacement = [Vector3(0, 0, depth)]
    return wanted


def loader(seen, _):
    """Pulls and lets go, once a second."""
    while True:
        for depth in (0.002, 0.0):
            called(seen, "apply_load", ApplyLoad, load_request(depth))
            time.sleep(1.0)


def controller(seen):
    return [count(seen, "/tf", TFMessage, lambda message: ()),
            count(seen, "sphere/measured_cf", WrenchStamped, wrench_numbers),
            count(seen, "/diagnostics", DiagnosticArray, lambda message: due_poses(seen, message)),
            count(seen, "state", TissueState, lambda message: stages(seen, message))]


def viewer(seen):
    return [count(seen, "surface", Surface, surface_numbers),
            count(seen, "contacts", ContactArray, contact_numbers),
            count(seen, "markers", MarkerArray, lambda message: ())]


def main():
    role, node_pid = sys.argv[1], int(sys.argv[2])
    rospy.init_node("soak_" + role, disable_signals=True)
    seen = Seen()
    if role in ("surgeon", "loader"):
        work = {"surgeon": surgeon, "loader": loader}[role]
        rospy.wait_for_service(NODE + "reset")
        threading.Thread(target=work, args=(seen, node_pid), daemon=True).start()
    else:
        kept = {"controller": controller, "viewer": viewer}[role](seen)
        assert kept
    for _ in sys.stdin:  # a line asks for a line
        seen.tell()


if __name__ == "__main__":
    main()
