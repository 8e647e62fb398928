"""Tells the rate, delay and processor time of a tissue node while a tool presses.

Starts a master and a node on a block of 4,851 nodes and moves a sphere in it; with --listen, listens
to a node that runs already. Needs the build's devel/setup.bash.

Delay: the age of the pose's TF stamp when the update's wrenches and markers had gone out, by the
node's own clock, of the updates that solved something. Where it moves
the sphere, it also counts the wrenches that a listener gets (~wrench_rate 1000). What a tool that
stands costs, the study still_node tells.
"""
import os
import sys
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import WrenchStamped
from robot_tissue.msg import TissueState

from studies import moved_node
from studies.common import DATA, percentile, write_rows

TABLE = DATA / "node_speed.csv"
STAGES = ("pose_age_ms", "contact_ms", "solve_ms", "publish_ms")


def longest_run_rate(stamps):
    """Updates per second over the stretches without a pause of more than 0.1 s."""
    gaps = [b - a for a, b in zip(stamps, stamps[1:]) if 0 < b - a < 0.1]
    return len(gaps) / sum(gaps)


def solving(states):
    return [s for s in list(states) if s.substeps > 0 and s.active_nodes > 0 and s.solve_ms > 0]


def tell(states, marker_arrays, seconds):
    """Prints and returns what the updates with contact took."""
    pressing = solving(states)
    if len(pressing) < 10:
        sys.exit(f"{len(pressing)} updates with contact in {seconds:g} s: nothing to measure")
    rate = longest_run_rate([s.header.stamp.to_sec() for s in pressing])
    print(f"{len(pressing)} updates with contact, {len(marker_arrays)} marker arrays, "
          f"{rate:.1f} updates/s while pressing")
    told = [("updates_per_s", rate)]
    for name in STAGES:
        values = [getattr(s, name) for s in pressing]
        print(f"{name}: median {percentile(values, 50):.2f}, 99th percentile "
              f"{percentile(values, 99):.2f}")
        told += [(name + "_median", percentile(values, 50)), (name + "_99", percentile(values, 99))]
    bad = [s.status for s in pressing if s.status != "OK"]
    print(f"not OK: {len(bad)} of {len(pressing)}, {bad.count('LATE')} of them LATE; "
          "deepest in the surface "
          f"{1e3 * max(s.max_penetration for s in pressing):.3f} mm")
    return told + [("not_ok_percent", 100.0 * len(bad) / len(pressing)),
                   ("late_percent", 100.0 * bad.count("LATE") / len(pressing)),
                   ("deepest_mm", 1e3 * max(s.max_penetration for s in pressing))]


def listen(node):
    states, marker_arrays = [], []
    rospy.Subscriber(node + "/state", TissueState, states.append, queue_size=1000)
    # Nobody builds markers for nobody: listening makes the node do its whole work.
    rospy.Subscriber(node + "/markers", rospy.AnyMsg, marker_arrays.append, queue_size=1)
    return states, marker_arrays


def run_node(options):
    with moved_node.own_master("measure_node"), moved_node.tissue_node(
            rate=options.rate, marker_rate=options.marker_rate, wrench_rate=1000,
            max_ms=options.max_ms):
        return measure(options)


def measure(options):
    states, marker_arrays = listen("/robot_tissue")
    robot = moved_node.Robot(options.speed)
    while not states or states[-1].status != "OK":
        robot.move(0.2, options.rate, moves=False)
    gone = robot.move(2 * moved_node.PRESS / options.speed + 0.5, options.rate)
    del states[:], marker_arrays[:]
    load = os.getloadavg()[0]
    gone = robot.move(options.seconds, options.rate, gone=gone)
    told = tell(states, marker_arrays, options.seconds)
    wrenches = []
    listener = rospy.Subscriber("/robot_tissue/sphere/measured_cf", WrenchStamped,
                                lambda wrench: wrenches.append(time.monotonic()),
                                queue_size=1000, tcp_nodelay=True)
    robot.move(5.0, options.rate, gone=gone)
    listener.unregister()
    wrench_rate = (len(wrenches) - 1) / (wrenches[-1] - wrenches[0])
    print(f"{wrench_rate:.1f} wrenches/s at a wrench_rate of 1000 with contact")
    return [("load_average", load)] + told + [("wrenches_per_s", wrench_rate)]


def add_arguments(parser):
    parser.add_argument("--listen", metavar="NODE", help="to a running node, e.g. /robot_tissue")
    parser.add_argument("--seconds", type=float, default=20.0, help="that are measured (20)")
    parser.add_argument("--rate", type=float, default=200.0, metavar="HZ", help="of the poses (200)")
    parser.add_argument("--marker-rate", type=float, default=30.0, metavar="HZ")
    parser.add_argument("--speed", type=float, default=0.02, metavar="M/S")
    parser.add_argument("--max-ms", type=float, default=0.0, metavar="MS")
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")


def run(options):
    if options.listen:
        rospy.init_node("measure_node", anonymous=True)
        states, marker_arrays = listen(options.listen)
        rospy.sleep(options.seconds)
        tell(states, marker_arrays, options.seconds)
        return
    rows = [{"measure": name, "value": f"{value:.4g}"} for name, value in run_node(options)]
    write_rows(options.table, ["measure", "value"], rows)
