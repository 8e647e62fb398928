"""Lets the node run for an hour at 200 Hz with faults, and tells memory, rates and missed replies.

A sphere presses 5 mm into a block of 4,851 nodes and goes round, lifts, and comes again. Its poses come through
robot_state_publisher, 200 a second. Every 30 s none come for 2 s; every 90 s that publisher is killed, and started
again 2 s later. Four clients, a process each: one cuts and undoes, one pulls at a corner once a second, one listens
to wrenches and states, one to the surface, contacts and markers. What the node has in memory hangs on the cuts that
stand, so what its heap holds is looked at 2.5 s after each reset; beside it a node that only listens to TF is looked
at (empty_node). Exit code 1 where heap or memory surely grows after the first minute, by 1 MB in ten hours more than
that other node's does; where a reply was missed, a number was not finite, or fewer poses were followed in the end.
Needs the build's devel/setup.bash and its target empty_node.
"""
import contextlib
import itertools
import json
import math
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import rospy
from sensor_msgs.msg import JointState

from studies import moved_node
from studies.soak_client import memory_of
from studies.common import DATA, IMAGES, add_plot, numbers, percentile, program, pyplot, rows_of, write_rows

TABLE, CHART = DATA / "soak.csv", IMAGES / "soak.png"
COLUMNS = ["time_s", "memory_MB", "memory_after_reset_MB", "heap_after_reset_MB",
           "listener_memory_MB", "node_percent_of_a_core", "poses_hz",
           "transforms_hz", "wrenches_hz", "states_hz", "surface_hz", "contacts_hz", "markers_hz", "due_hz",
           "contact_ms", "solve_ms", "publish_ms", "calls", "refused", "missed", "slowest_reply_ms", "not_finite",
           "fault"]
STAGES = ("contact_ms", "solve_ms", "publish_ms")   # means of an update that told its state
ROLES = ("surgeon", "loader", "controller", "viewer")
RATE = 200.0                            # Hz, of the poses
PERIOD = 5.0                            # s, of a row
SILENT_EVERY, KILLED_EVERY, FAULT = 30.0, 90.0, 2.0     # s
LIFTED_EVERY, LIFTED = 20.0, 4.0        # s: how long of it the sphere is up
SPEED = 0.01                            # m/s
WARM = 60.0                             # s: memory grows to what it needs
MOST_GROWTH = 0.1                       # MB an hour
SURELY = 1.645                          # standard deviations: 95 %, on one side
FEWEST_RESETS = 9                       # fewer say nothing of growth
LEAST_HELD = 0.8                        # of the share of poses followed at first; others use the processor, too
URDF = """<robot name="soak">
  <link name="tissue"/><link name="along_x"/><link name="along_y"/>
  <link name="sphere"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  {}
</robot>"""
JOINT = """<joint name="{0}" type="prismatic"><parent link="{1}"/><child link="{2}"/><axis xyz="{3}"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""


def description():
    links = ["tissue", "along_x", "along_y", "sphere"]
    axes = ["1 0 0", "0 1 0", "0 0 1"]
    return URDF.format("".join(JOINT.format("xyz"[i], links[i], links[i + 1], axes[i]) for i in range(3)))


class Arm(threading.Thread):
    """Publishes the joints 200 times a second, but for faults."""

    def __init__(self):
        super().__init__(daemon=True)
        self.joints = rospy.Publisher("/joint_states", JointState, queue_size=100)
        self.robot = moved_node.Robot(SPEED)
        self.sent = 0
        self.silent = False

    def run(self):
        start, beat = time.monotonic(), 0
        while True:
            beat += 1
            time.sleep(max(0.0, start + beat / RATE - time.monotonic()))
            gone = time.monotonic() - start
            if self.silent:
                continue
            x, y, z = self.robot.place(SPEED * gone)
            if gone % LIFTED_EVERY < LIFTED:
                z += 0.01
            self.joints.publish(JointState(header=rospy.Header(stamp=rospy.Time.now()), name=["x", "y", "z"],
                                           position=[x, y, z]))
            self.sent += 1


class Faults(threading.Thread):
    """No joints for a while, and a publisher of the robot that is killed."""

    def __init__(self, arm):
        super().__init__(daemon=True)
        self.arm = arm
        self.publisher = self.start_publisher()
        self.seen = set()   # since a row was told

    @staticmethod
    def start_publisher():
        return subprocess.Popen(["rosrun", "robot_state_publisher", "robot_state_publisher",
                                 "_publish_frequency:=1000"], start_new_session=True)

    def kill_publisher(self):
        with contextlib.suppress(ProcessLookupError):   # the master went first
            os.killpg(self.publisher.pid, 9)
        self.publisher.wait()

    def run(self):
        start, beat = time.monotonic(), 0
        while True:
            beat += 1
            time.sleep(max(0.0, start + beat * SILENT_EVERY - time.monotonic()))
            killed = beat % round(KILLED_EVERY / SILENT_EVERY) == 0
            word = "killed" if killed else "silent"
            self.seen.add(word)
            if killed:
                self.kill_publisher()
                time.sleep(FAULT)
                self.publisher = self.start_publisher()
            else:
                self.arm.silent = True
                time.sleep(FAULT)
                self.arm.silent = False
            time.sleep(1.0)     # it is over when poses are followed again
            self.seen.add(word)


class Client:
    def __init__(self, role, node_pid):
        self.process = subprocess.Popen([sys.executable, str(Path(__file__).with_name("soak_client.py")), role,
                                         str(node_pid)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def end(self):
        self.process.stdin.close()
        try:
            self.process.wait(timeout=2.0 * PERIOD)
        except subprocess.TimeoutExpired:   # it waits for a reply of a node that is gone
            self.process.kill()
            self.process.wait()


def is_alive(pid):
    """One that died and that nobody has asked after is there, too, but as a zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def row_of(seen, passed, arm, sent, share):
    row = {name: seen.get(name, 0) for name in ("calls", "refused", "missed", "not_finite")}
    row["slowest_reply_ms"] = f"{seen.get('slowest_reply_ms', 0.0):.1f}"
    row["memory_after_reset_MB"] = f"{seen['rest_memory_MB']:.2f}" if "rest_memory_MB" in seen else ""
    row["heap_after_reset_MB"] = f"{seen['rest_heap_MB']:.3f}" if "rest_heap_MB" in seen else ""
    row["node_percent_of_a_core"] = f"{share:.1f}"
    row["poses_hz"] = f"{(arm.sent - sent) / passed:.1f}"
    for column, topic in (("transforms_hz", "/tf"), ("wrenches_hz", "sphere/measured_cf"), ("states_hz", "state"),
                          ("surface_hz", "surface"), ("contacts_hz", "contacts"), ("markers_hz", "markers")):
        row[column] = f"{seen.get(topic, 0) / passed:.1f}"
    row["due_hz"] = f"{seen.get('due', 0.0) / max(1, seen.get('/diagnostics', 0)):.1f}"
    for stage in STAGES:
        row[stage] = f"{seen.get(stage, 0.0) / max(1, seen.get('state', 0)):.2f}"
    return row


def merged(answers):
    seen = {}
    for answer in answers:
        for name, value in answer.items():
            seen[name] = max(seen.get(name, 0), value) if name == "slowest_reply_ms" else seen.get(name, 0) + value
    return seen


def measure(options, pid, listener, arm, faults, clients):
    rows, begin = [], time.monotonic()
    last, sent, busy = begin, arm.sent, sum(moved_node.processor_seconds(pid).values())
    while time.monotonic() - begin < 60.0 * options.minutes:
        time.sleep(max(0.0, begin + PERIOD * (len(rows) + 1) - time.monotonic()))
        if not is_alive(pid):
            sys.exit(f"soak: the node died after {time.monotonic() - begin:.0f} s")
        words, faults.seen = faults.seen, set()
        now, busy_before, sent_before = time.monotonic(), busy, sent
        busy, sent = sum(moved_node.processor_seconds(pid).values()), arm.sent
        passed = now - last
        row = row_of(merged([client.ask() for client in clients]), passed, arm, sent_before,
                     100.0 * (busy - busy_before) / passed)
        row["memory_MB"], row["listener_memory_MB"] = (f"{memory_of(one):.2f}" for one in (pid, listener))
        last = now
        row["time_s"], row["fault"] = f"{now - begin:.0f}", " ".join(sorted(words))
        rows.append(row)
        write_rows(options.table, COLUMNS, rows)
    return rows


def thirds_of(values):
    """Medians of the first third and of the last."""
    third = max(1, len(values) // 3)
    return percentile(values[:third], 50), percentile(values[-third:], 50)


def growth(rows, column):
    """MB an hour, the median of all pairs of rows that have the column (Theil, Sen), and what it is at least."""
    points = [(float(row["time_s"]) / 3600.0, float(row[column])) for row in rows if row[column]]
    slopes = sorted((after - before) / (late - early) for (early, before), (late, after)
                    in itertools.combinations(points, 2))
    count = len(points)
    doubt = SURELY * math.sqrt(count * (count - 1) * (2 * count + 5) / 18.0)    # of the pairs that rise (Kendall)
    return percentile(slopes, 50), slopes[max(0, math.floor((len(slopes) - doubt) / 2.0))]


def findings_of_memory(rows):
    """A line for what surely grows more than the memory of a node that only listens to TF."""
    resets = sum(bool(row["heap_after_reset_MB"]) for row in rows)
    if resets < FEWEST_RESETS:
        print(f"memory: {resets} resets after the first minute are too few to tell whether it grows")
        return []
    listener, _ = growth(rows, "listener_memory_MB")
    print(f"memory of a node that only listens to TF: {1e3 * listener:+.0f} kB an hour")
    findings = []
    for column, what in (("heap_after_reset_MB", "heap after resets"), ("memory_MB", "memory at any time")):
        values = [float(row[column]) for row in rows if row[column]]
        middle, least = growth(rows, column)
        first, last = thirds_of(values)
        print(f"{what}: {min(values):.2f} to {max(values):.2f} MB, in the first third {first:.2f}, in the "
              f"last {last:.2f} (medians); {1e3 * middle:+.0f} kB an hour, surely {1e3 * least:+.0f}")
        if least - max(0.0, listener) > MOST_GROWTH:
            findings.append(f"{what} grows")
    return findings


def findings_of(rows):
    """What is wrong, a line each."""
    findings = []
    for column, what in (("missed", "replies were missed"), ("not_finite", "numbers were not finite")):
        total = int(sum(numbers(rows, column)))
        if total:
            findings.append(f"{total} {what}")
    late = [row for row in rows if float(row["time_s"]) > WARM]
    findings += findings_of_memory(late)
    quiet = [row for row in late or rows if not row["fault"]] or rows
    shares = [float(row["wrenches_hz"]) / max(1.0, float(row["transforms_hz"])) for row in quiet]
    first, last = thirds_of(shares)
    print(f"without a fault: {percentile(numbers(quiet, 'transforms_hz'), 50):.0f} poses and "
          f"{percentile(numbers(quiet, 'wrenches_hz'), 50):.0f} wrenches a second; {100.0 * first:.0f} % of the poses "
          f"followed in the first third, {100.0 * last:.0f} % in the last")
    if last < LEAST_HELD * first:
        findings.append("the rate fell")
    due, share = (percentile(numbers(quiet, column), 50) for column in ("due_hz", "node_percent_of_a_core"))
    print(f"of the poses {due:.0f} a second were due by the node's own count; an update's parts, mean: " + ", ".join(
        f"{stage[:-3]} {percentile(numbers(quiet, stage), 50):.2f} ms" for stage in STAGES) +
        f"; {share:.0f} % of a core")
    replies = numbers(rows, "slowest_reply_ms")
    print(f"{int(sum(numbers(rows, 'calls')))} calls, {int(sum(numbers(rows, 'refused')))} refused; slowest reply "
          f"{max(replies):.0f} ms, median of the slowest in 5 s {percentile(replies, 50):.0f} ms")
    return findings


def draw(rows, path):
    plot = pyplot()
    figure, axes = plot.subplots(3, 1, sharex=True, figsize=(8, 7), constrained_layout=True)
    minutes = [float(row["time_s"]) / 60.0 for row in rows]
    axes[0].plot(minutes, numbers(rows, "memory_MB"), color="tab:blue", alpha=0.5, linewidth=1.0, label="at any time")
    for column, color, label in (("memory_after_reset_MB", "tab:blue", "after a reset"),
                                 ("heap_after_reset_MB", "tab:green", "of it the heap holds")):
        resets = [(minute, float(row[column])) for minute, row in zip(minutes, rows) if row[column]]
        axes[0].plot(*zip(*resets), ".", color=color, label=label)
    axes[0].plot(minutes, numbers(rows, "listener_memory_MB"), color="0.4", label="node that only listens to TF")
    axes[0].set_ylabel("memory (MB)")
    axes[0].set_ylim(bottom=0.0)
    axes[0].legend(loc="center right", ncol=2)
    axes[1].plot(minutes, numbers(rows, "transforms_hz"), color="0.6", label="poses")
    for column, label in (("wrenches_hz", "wrenches"), ("surface_hz", "surface")):
        axes[1].plot(minutes, numbers(rows, column), label=label, linewidth=1.0)
    axes[1].set_ylabel("messages a second")
    axes[1].legend(loc="center right")
    axes[2].plot(minutes, numbers(rows, "slowest_reply_ms"), color="tab:red")
    axes[2].set_ylabel("slowest reply in 5 s (ms)")
    axes[2].set_xlabel("minutes; shaded: no poses (gray), robot_state_publisher killed (orange)")
    for axis in axes:
        axis.grid(alpha=0.3)
        for minute, row in zip(minutes, rows):
            if row["fault"]:
                color = "tab:orange" if "killed" in row["fault"] else "0.5"
                axis.axvspan(minute - PERIOD / 60.0, minute, color=color, alpha=0.25, linewidth=0)
    figure.savefig(path, dpi=100)


def add_arguments(parser):
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")
    parser.add_argument("--chart", type=Path, default=CHART)
    add_plot(parser)


@contextlib.contextmanager
def clients_of(roles, node_pid):
    clients = [Client(role, node_pid) for role in roles]
    try:
        yield clients
    finally:
        for client in clients:
            client.end()


def run_node(options):
    with moved_node.own_master("soak"):
        with moved_node.tissue_node(rate=RATE, marker_rate=10, wrench_rate=0), \
                moved_node.running([program("empty_node"), "at_once", "none"]):
            while not rospy.has_param("/robot_description"):
                time.sleep(0.1)
            rospy.set_param("/robot_description", description())
            arm = Arm()
            faults = Faults(arm)
            try:
                arm.start()
                rospy.wait_for_service("/robot_tissue/reset")
                pid, listener = moved_node.pid_of("/robot_tissue"), moved_node.pid_of("/empty_node")
                with clients_of(ROLES, pid) as clients:
                    time.sleep(3.0)
                    for client in clients:
                        client.ask()
                    faults.start()
                    return measure(options, pid, listener, arm, faults, clients)
            finally:
                faults.kill_publisher()


def run(options):
    rows = rows_of(options.table) if options.plot else run_node(options)
    draw(rows, options.chart)
    findings = findings_of(rows)
    for finding in findings:
        print("soak: " + finding)
    if findings:
        sys.exit(1)
