"""Tells how old a pose is when the wrenches solved for it come, and how many of 200 a second do.

Starts a master and a node on a block of 4,851 nodes, for each run anew, and moves a tool through it: a sphere, a hand
(palm and two fingers, meshes of 3,000 triangles each; the fingers' tips touch), or three such fingers. Pressed in by
5 mm, once round at 20 mm/s, drawn out, again and again, with listeners to wrenches, state and markers. The program
pose_age sends the poses and takes the time from a pose's stamp to when the last of its wrenches was received: sending,
receiving and the scheduler are in it. Counts as well the wrenches that a listener gets with ~wrench_rate 1000. Needs
the build's devel/setup.bash, and its target pose_age. What a tool that stands costs, the study still_node tells.
"""
import csv
import io
import os
import subprocess
import tempfile
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import WrenchStamped

from studies import hand, moved_node
from studies.common import (DATA, IMAGES, add_plot, add_programs, numbers, percentile, program, progress, pyplot,
                            rows_of, write_rows)

TABLE, AGES, CHART = DATA / "node_speed.csv", DATA / "node_age.csv", IMAGES / "node_age.png"
STAGES = ("contact_ms", "solve_ms", "publish_ms")
COLUMNS = ["tool", "run", "load_average", "poses", "wrenches_per_s", "age_ms_median", "age_ms_90", "age_ms_99",
           "age_ms_greatest", *(f"{stage}_{part}" for stage in STAGES for part in ("median", "99")), "not_ok_percent",
           "late_percent"]
AGE_COLUMNS = ["tool", "percent", "age_ms"]
PERCENTS = [*range(2, 90, 2), *(90 + 0.5 * step for step in range(20)), 99.9]
# Links, where each is off the hand's middle and over its lowest point (m), and the file of the tools.
TOOLS = {
    "sphere": ([("sphere", 0.0, 0.0, moved_node.RADIUS)], "node_sphere.yaml"),
    "hand": ([(name, *place) for name, place in hand.HAND.items()], "node_hand.yaml"),
    "fingers": ([(name, *place) for name, place in hand.FINGERS.items()], "node_fingers.yaml"),
}
GOALS_MS = {"sphere": 3.0, "hand": 6.0}     # of the 99th percentile
COLORS = {"sphere": "tab:blue", "hand": "tab:orange", "fingers": "tab:green"}


def node_of(tool, folder, options, wrench_rate=0):
    robot = {} if tool == "sphere" else {"description": hand.write(folder)}
    return moved_node.tissue_node(rate=options.rate, marker_rate=options.marker_rate, wrench_rate=wrench_rate,
                                  max_ms=options.max_ms, max_iterations=options.max_iterations,
                                  tools=moved_node.LAUNCH_FILE.with_name(TOOLS[tool][1]), **robot)


def poses_of(tool, options):
    """What pose_age tells of each."""
    command = [program("pose_age", options.programs), options.seconds, options.rate, options.speed]
    for link in TOOLS[tool][0]:
        command += link
    # Without a node, as where its launch failed, it would wait for ever.
    told = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, check=True, text=True,
                          timeout=options.seconds + 60.0).stdout
    return list(csv.DictReader(io.StringIO(told)))


def row_of(tool, run, load, poses, options):
    followed = [pose for pose in poses if pose["age_ms"]]
    ages = numbers(followed, "age_ms")
    touching = [pose for pose in poses if pose["solve_ms"] and float(pose["solve_ms"]) > 0.0]
    values = {"load_average": load, "poses": len(poses), "wrenches_per_s": len(ages) / len(poses) * options.rate,
              "age_ms_median": percentile(ages, 50), "age_ms_90": percentile(ages, 90),
              "age_ms_99": percentile(ages, 99), "age_ms_greatest": max(ages)}
    for stage in STAGES:
        taken = numbers(touching, stage)
        values[stage + "_median"], values[stage + "_99"] = percentile(taken, 50), percentile(taken, 99)
    bad = [pose["status"] for pose in touching if pose["status"] != "OK"]
    values["not_ok_percent"] = 100.0 * len(bad) / len(touching)
    values["late_percent"] = 100.0 * bad.count("LATE") / len(touching)
    return {"tool": tool, "run": run, **{name: f"{value:.4g}" for name, value in values.items()}}, ages


def tell(row):
    print("{tool}: load {load_average}; {wrenches_per_s} wrenches/s; age {age_ms_median} ms, 90 % {age_ms_90}, 99 % "
          "{age_ms_99}, greatest {age_ms_greatest}; contact {contact_ms_median}, {contact_ms_99}; solve "
          "{solve_ms_median}, {solve_ms_99}; publish {publish_ms_median}, {publish_ms_99}; not OK {not_ok_percent} %"
          .format(**row), flush=True)


def measure(tool, run, options):
    with tempfile.TemporaryDirectory() as folder, node_of(tool, Path(folder), options):
        load = os.getloadavg()[0]
        return row_of(tool, run, load, poses_of(tool, options), options)


def count_wrenches(options):
    """A second, by ~wrench_rate 1000, while the sphere presses and goes round."""
    robot, came = moved_node.Robot(options.speed), []
    with tempfile.TemporaryDirectory() as folder, node_of("sphere", Path(folder), options, 1000):
        rospy.wait_for_message("/robot_tissue/state", rospy.AnyMsg)
        gone = robot.move(2 * moved_node.PRESS / options.speed + 2.0, options.rate)
        listener = rospy.Subscriber("/robot_tissue/sphere/measured_cf", WrenchStamped,
                                    lambda wrench: came.append(time.monotonic()), queue_size=1000, tcp_nodelay=True)
        robot.move(5.0, options.rate, gone=gone)
        listener.unregister()
    rate = (len(came) - 1) / (came[-1] - came[0])
    print(f"{rate:.1f} wrenches/s at a wrench_rate of 1000 with contact")
    return {"tool": "sphere, wrench_rate 1000", "wrenches_per_s": f"{rate:.4g}"}


def quantiles(tool, ages):
    return [{"tool": tool, "percent": f"{percent:g}", "age_ms": f"{percentile(ages, percent):.4g}"}
            for percent in PERCENTS]


def draw(rows):
    plt = pyplot()
    figure, axis = plt.subplots(figsize=(7.0, 3.6), constrained_layout=True)
    for tool, color in COLORS.items():
        own = [row for row in rows if row["tool"] == tool]
        axis.plot(numbers(own, "age_ms"), numbers(own, "percent"), color=color, label=tool)
        if tool in GOALS_MS:
            axis.axvline(GOALS_MS[tool], color=color, linestyle=":", linewidth=1.0)
    axis.axhline(99.0, color="0.5", linewidth=0.8)
    axis.set_xscale("log")
    axis.set_xticks([1, 2, 3, 5, 10, 20, 50, 100], labels=["1", "2", "3", "5", "10", "20", "50", "100"])
    axis.set_xlabel("age of the pose when its wrenches come (ms); dotted: goals at 99 %")
    axis.set_ylabel("share of the poses (%)")
    axis.grid(alpha=0.3)
    axis.legend(loc="lower right")
    figure.savefig(CHART, dpi=100)


def add_arguments(parser):
    parser.add_argument("--tools", nargs="+", choices=TOOLS, default=list(TOOLS))
    parser.add_argument("--runs", type=int, default=5, help="of each tool, in turns (5)")
    parser.add_argument("--seconds", type=float, default=20.0, help="of a run (20)")
    parser.add_argument("--rate", type=float, default=200.0, metavar="HZ", help="of the poses (200)")
    parser.add_argument("--marker-rate", type=float, default=30.0, metavar="HZ")
    parser.add_argument("--speed", type=float, default=0.02, metavar="M/S")
    parser.add_argument("--max-ms", type=float, default=0.0, metavar="MS")
    parser.add_argument("--max-iterations", default="", metavar="N", help="of a load step; the node's own")
    parser.add_argument("--dry", action="store_true", help="write and draw nothing")
    add_programs(parser)
    add_plot(parser)


def run(options):
    if options.plot:
        return draw(rows_of(AGES))
    rows, ages = [], {tool: [] for tool in options.tools}
    with moved_node.own_master("measure_node"):
        for turn, tool in progress([(turn, tool) for turn in range(options.runs) for tool in options.tools]):
            row, of_run = measure(tool, turn + 1, options)
            rows.append(row)
            ages[tool] += of_run
            tell(row)
        if not options.dry:
            rows.append(count_wrenches(options))
    if options.dry:
        return None
    write_rows(TABLE, COLUMNS, rows)
    write_rows(AGES, AGE_COLUMNS, [row for tool in ages for row in quantiles(tool, ages[tool])])
    return draw(rows_of(AGES))
