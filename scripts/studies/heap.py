"""Tells what each kind of use leaves in the node's heap: one kind at a time, as fast as it goes.

A block of 4,851 nodes, a sphere above it, its poses 200 a second. After each of nine rounds of one kind all is reset,
and the node tells what its heap holds. The first round is not counted: what is needed at the first use stays. Growth
is from the median of the next four to that of the last four; times are those of the last four. For a publisher of
transforms that is killed a node that only listens to TF is looked at, too (its memory). Needs the build's
devel/setup.bash and its target empty_node. Out: doc/data/heap.csv.
"""
import os
import random
import statistics
import subprocess
import threading
import time
from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, WrenchStamped
from robot_tissue.msg import ContactArray, Surface
from robot_tissue.srv import ApplyLoad, Cut, Remove, RemoveRequest, Suture, SutureRequest
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from studies import moved_node
from studies.common import DATA, program, write_rows
from studies.soak_client import HEAP, NODE, cut_request, diagnosed, load_request, memory_of

TABLE = DATA / "heap.csv"
COLUMNS = ["kind", "times", "heap_least_MB", "heap_most_MB", "heap_grew_kB", "listener_grew_kB"]
ROUNDS, ROUND = 9, 8.0          # and s of each
TIDY = 2.5                      # s after a reset: the node has told its heap since
RATE, SPEED = 200.0, 0.01       # Hz, m/s
LIFT = 0.02                     # m
GONE = 2.0                      # s, that a killed publisher is away


class Arm(threading.Thread):
    """The sphere stands above the block, or is pressed in and goes round."""

    def __init__(self):
        super().__init__(daemon=True)
        self.robot, self.presses = moved_node.Robot(SPEED), False

    def run(self):
        start, beat, gone = time.monotonic(), 0, 0.0
        while True:
            beat += 1
            time.sleep(max(0.0, start + beat / RATE - time.monotonic()))
            gone += SPEED / RATE if self.presses else 0.0
            transform = self.robot.transform(gone)
            transform.transform.translation.z += 0.0 if self.presses else LIFT
            self.robot.publisher.publish(moved_node.TFMessage([transform]))


class Uses:
    """Each tells how many calls, listeners or publishers it was."""

    def __init__(self):
        self.random = random.Random(22)
        self.services = {name: rospy.ServiceProxy(NODE + name, kind, persistent=True) for name, kind in (
            ("apply_load", ApplyLoad), ("cut", Cut), ("undo", Trigger), ("reset", Trigger), ("suture", Suture),
            ("remove", Remove))}

    def call(self, name, *request):
        return self.services[name](*request)

    def refused_by_a_new_connection(self):
        rospy.ServiceProxy(NODE + "undo", Trigger)()
        return 1

    def load_and_release(self):
        for depth in (0.002, 0.0):
            self.call("apply_load", load_request(depth))
        return 2

    def cut_and_undo(self):
        for _ in range(2):
            self.call("cut", cut_request(self.random))
        for _ in range(2):
            self.call("undo")
        return 4

    def cut_and_reset(self):
        self.call("cut", cut_request(self.random))
        self.call("reset")
        return 2

    def suture_and_undo(self):
        self.call("suture", SutureRequest(start=Point(0.02, 0.02, 0.05), end=Point(0.03, 0.02, 0.05)))
        self.call("undo")
        return 2

    def remove_and_undo(self):
        self.call("remove", RemoveRequest(center=Point(0.05, 0.05, 0.05), radius=0.01))
        self.call("undo")
        return 2

    def listeners_come_and_go(self):
        kinds = {"sphere/measured_cf": WrenchStamped, "markers": MarkerArray, "surface": Surface,
                 "contacts": ContactArray}
        listeners = [rospy.Subscriber(NODE + topic, kind, lambda message: None) for topic, kind in kinds.items()]
        time.sleep(0.2)
        for listener in listeners:
            listener.unregister()
        return len(listeners)

    def pressed(self):
        time.sleep(0.1)
        return round(0.1 * RATE)

    def publisher_killed(self):
        publisher = subprocess.Popen(["rosrun", "robot_state_publisher", "robot_state_publisher"],
                                     start_new_session=True)
        time.sleep(1.0)
        os.killpg(publisher.pid, 9)
        publisher.wait()
        time.sleep(GONE)
        return 1


KINDS = {"request refused, a connection each": Uses.refused_by_a_new_connection,
         "load and release": Uses.load_and_release, "cut and undo": Uses.cut_and_undo,
         "cut and reset": Uses.cut_and_reset, "suture and undo": Uses.suture_and_undo,
         "remove and undo": Uses.remove_and_undo, "pose of a pressed tool": Uses.pressed,
         "listener comes and goes": Uses.listeners_come_and_go,
         "publisher of /tf killed, back after 2 s": Uses.publisher_killed}


def row_of(name, use, uses, arm, heap, listener):
    """Of what the heap holds after each round."""
    held, beside, times = [], [], 0
    for place in range(ROUNDS):
        start = time.monotonic()
        while time.monotonic() - start < ROUND:
            arm.presses = use is Uses.pressed
            done = use(uses)
            times += done if place > ROUNDS // 2 else 0
        arm.presses = False
        uses.call("reset")
        time.sleep(TIDY)
        held.append(heap[-1])
        beside.append(memory_of(listener))
    held, beside = held[1:], beside[1:]
    return {"kind": name, "times": times, "heap_least_MB": f"{min(held):.3f}", "heap_most_MB": f"{max(held):.3f}",
            "heap_grew_kB": f"{grown(held):+.0f}", "listener_grew_kB": f"{grown(beside):+.0f}"}


def grown(values):
    """kB, from the first half of the MB to the second."""
    half = len(values) // 2
    return 1e3 * (statistics.median(values[half:]) - statistics.median(values[:half]))


def add_arguments(parser):
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")


def run(options):
    rows = []
    with moved_node.own_master("heap"), moved_node.tissue_node(rate=RATE, marker_rate=10, wrench_rate=0), \
            moved_node.running([program("empty_node"), "at_once", "none"]):
        heap = []
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: heap.extend(diagnosed(message, HEAP)))
        rospy.wait_for_service(NODE + "reset")
        arm, uses = Arm(), Uses()
        arm.start()
        listener = moved_node.pid_of("/empty_node")
        for name, use in KINDS.items():
            rows.append(row_of(name, use, uses, arm, heap, listener))
            print(" ".join(f"{column}={rows[-1][column]}" for column in COLUMNS), flush=True)
    write_rows(options.table, COLUMNS, rows)
