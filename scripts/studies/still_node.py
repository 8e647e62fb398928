"""Tells what a tissue node costs while nothing moves, beside a node that does nothing.

The processor's time of the whole process as a share of one core: median, least and greatest of
N runs (3) of S seconds (20) with TF at HZ (200). Needs the build's devel/setup.bash.
"""
import statistics
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import WrenchStamped
from tf2_msgs.msg import TFMessage

from studies import moved_node
from studies.common import DATA, program, progress, write_rows

TABLE = DATA / "still_node.csv"
COLUMNS = ["case", "percent_median", "least", "greatest", "wrenches_per_s"]

PRESSED = 2 * moved_node.PRESS      # gone (m): in contact, at depth
SETTLING = 3.0                      # s, before it is measured

# Name, arguments of empty_node or wrench_rate of the tissue node, robot, listeners of wrenches.
# Robots: none; fixed: its only transform is static; far, near (in contact): stands; passes: moves
# far off; other: near by a static transform while other frames are told.
CASES = (
    ("empty, no TF", ("none", "none"), "none", 0),
    ("empty, no listener, TF sent", ("none", "none"), "near", 0),
    ("empty, tf2's thread", ("own_thread", "none"), "near", 0),
    ("empty, tf2's thread, no TF", ("own_thread", "none"), "none", 0),
    ("empty, node's queue", ("node_queue", "none"), "near", 0),
    ("empty, node's queue, no TF", ("node_queue", "none"), "none", 0),
    ("empty, tf2's thread, wrench a pose", ("own_thread", "pose"), "near", 1),
    ("empty, node's queue, wrench a pose", ("node_queue", "pose"), "near", 1),
    ("empty, at once", ("at_once", "none"), "near", 0),
    ("empty, at once, wrench a pose", ("at_once", "pose"), "near", 1),
    ("empty, no TF, wrenches at 200 Hz", ("none", "200"), "none", 1),
    ("empty, no TF, wrenches at 1000 Hz", ("none", "1000"), "none", 1),
    ("empty, node's queue, wrenches at 1000 Hz", ("node_queue", "1000"), "near", 1),
    ("tissue, no TF", 0, "none", 0),
    ("tissue, static TF in contact", 0, "fixed", 0),
    ("tissue, static TF in contact, one listens", 0, "fixed", 1),
    ("tissue, TF of others, static in contact", 0, "other", 0),
    ("tissue, tool stands far off", 0, "far", 0),
    ("tissue, tool moves far off", 0, "passes", 0),
    ("tissue, tool stands in contact", 0, "near", 0),
    ("tissue, tool stands in contact, one listens", 0, "near", 1),
    ("tissue, in contact, wrench_rate 1000, none listens", 1000, "near", 0),
    ("tissue, in contact, wrench_rate 1000, one listens", 1000, "near", 1),
)


class Sender:
    """The robot of a case, at a rate."""

    def __init__(self, kind, rate):
        self.kind, self.rate, self.gone = kind, rate, PRESSED
        far = kind in ("far", "passes")
        self.robot = moved_node.Robot(speed=0.02, frame="elbow" if kind == "other" else "sphere",
                                      aside=0.3 if far else 0.0)
        self.fixed = None
        if kind in ("fixed", "other"):
            self.fixed = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
            self.fixed.publish(TFMessage([moved_node.Robot().transform(PRESSED)]))

    def send(self, seconds):
        if self.kind in ("none", "fixed"):
            time.sleep(seconds)
        else:
            self.gone = self.robot.move(seconds, self.rate, self.kind == "passes", self.gone)

    def close(self):
        if self.fixed:
            self.fixed.unregister()


def node_of(case):
    """As a running process, and its name."""
    _, kind, _, _ = case
    if isinstance(kind, tuple):
        return moved_node.running([program("empty_node"), *kind]), "/empty_node"
    return moved_node.tissue_node(rate=200, marker_rate=30, wrench_rate=kind), "/robot_tissue"


def started(name, sender):
    """The node's process, once it is there and the robot is known to it."""
    while True:
        try:
            pid = moved_node.pid_of(name)
            sender.send(SETTLING)
            return pid
        except OSError:
            time.sleep(0.2)


def measure(case, options):
    """Shares of a core in percent, one a run; of each thread; wrenches per second."""
    sender, wrenches = Sender(case[2], options.rate), []
    node, name = node_of(case)
    with node:
        pid = started(name, sender)
        listeners = [rospy.Subscriber(name + "/sphere/measured_cf", WrenchStamped,
                                      wrenches.append, tcp_nodelay=True)
                     for _ in range(case[3])]
        sender.send(SETTLING)
        del wrenches[:]
        shares, threads = [], []
        for _ in range(options.repeats):
            before = moved_node.processor_seconds(pid)
            sender.send(options.seconds)
            after = moved_node.processor_seconds(pid)
            threads.append({thread: 100.0 * (after[thread] - before.get(thread, 0.0)) /
                            options.seconds for thread in after})
            shares.append(sum(threads[-1].values()))
        for listener in listeners:
            listener.unregister()
        sender.close()
    return shares, threads, len(wrenches) / (options.repeats * options.seconds)


def add_arguments(parser):
    parser.add_argument("--seconds", type=float, default=20.0, help="of a run (20)")
    parser.add_argument("--repeats", type=int, default=3, help="runs of a case (3)")
    parser.add_argument("--rate", type=float, default=200.0, metavar="HZ", help="of TF (200)")
    parser.add_argument("--only", default="", metavar="TEXT", help="cases with it in their names")
    parser.add_argument("--threads", action="store_true", help="also each thread's share")
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")


def run(options):
    rows = []
    with moved_node.own_master("measure_still"):
        for case in progress([case for case in CASES if options.only in case[0]], lambda c: c[0]):
            shares, threads, wrench_rate = measure(case, options)
            values = (statistics.median(shares), min(shares), max(shares), wrench_rate)
            rows.append(dict(zip(COLUMNS, (case[0], *(f"{value:.3g}" for value in values)))))
            print("{}: {:.2f} % of a core ({:.2f} to {:.2f}), {:.1f} wrenches/s".format(
                case[0], *values), flush=True)
            if options.threads:
                print("   " + ", ".join(f"{share:.2f}" for share in threads[-1].values()))
    write_rows(options.table, COLUMNS, rows)
