"""Tells what listeners of the shape's topics cost the node: bytes a second, and processor.

A sphere goes round in a block of 35,301 nodes, pressed in by 5 mm, a pose and a message 30 times a
second. Share of one core of the node's whole process, without a listener and with one of each topic. Needs the
build's devel/setup.bash.
"""
import time
from pathlib import Path

import rospy

from studies import moved_node
from studies.common import DATA, progress, write_rows

TABLE = DATA / "shape_topics.csv"
COLUMNS = ["listener", "messages_per_s", "kB_per_message", "MB_per_s", "node_percent_of_a_core"]
SPACING = 0.0025                # m: 41 x 41 x 21 nodes
TOPICS = ("none", "surface", "nodes", "contacts", "markers")


def measure(topic, robot, pid, gone, options):
    """A row, and how far the sphere has gone."""
    sizes = []
    listener = None
    if topic != "none":
        listener = rospy.Subscriber(f"/robot_tissue/{topic}", rospy.AnyMsg,
                                    lambda message: sizes.append(len(message._buff)),
                                    queue_size=100, buff_size=2 ** 24, tcp_nodelay=True)
    gone = robot.move(1.0, options.rate, gone=gone)
    del sizes[:]
    before, start = sum(moved_node.processor_seconds(pid).values()), time.monotonic()
    gone = robot.move(options.seconds, options.rate, gone=gone)
    passed = time.monotonic() - start
    share = 100.0 * (sum(moved_node.processor_seconds(pid).values()) - before) / passed
    told = list(sizes)
    if listener:
        listener.unregister()
    mean = 1e-3 * sum(told) / len(told) if told else 0.0
    values = (len(told) / passed, mean, 1e-6 * sum(told) / passed, share)
    print("{}: {:.1f} messages/s, {:.0f} kB each, {:.2f} MB/s, node {:.1f} % of a core".format(
        topic, *values), flush=True)
    return dict(zip(COLUMNS, (topic, *(f"{value:.3g}" for value in values)))), gone


def add_arguments(parser):
    parser.add_argument("--seconds", type=float, default=15.0, help="of a topic (15)")
    parser.add_argument("--rate", type=float, default=30.0, metavar="HZ", help="of the poses (30)")
    parser.add_argument("--speed", type=float, default=0.01, metavar="M/S")
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")


def run(options):
    rows = []
    with moved_node.own_master("measure_shape"), moved_node.tissue_node(
            rate=100, marker_rate=100, wrench_rate=0, spacing=SPACING):
        robot = moved_node.Robot(options.speed)
        while True:
            try:
                pid = moved_node.pid_of("/robot_tissue")
                break
            except OSError:  # not there yet
                time.sleep(0.2)
        gone = robot.move(2 * moved_node.PRESS / options.speed + 3.0, options.rate)
        for topic in progress(TOPICS):
            row, gone = measure(topic, robot, pid, gone, options)
            rows.append(row)
    write_rows(options.table, COLUMNS, rows)
