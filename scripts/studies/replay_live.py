"""Compares a bag played beside the node, at its own and at five times its speed, with `replay`.

The bag is the demo's robot over one round of its trajectory (it presses, drags, cuts and pulls), 200 transforms a
second; --bag takes another of that robot. `replay` follows it without a master, at the scene's rate and at a tenth
of it; then the node follows it live, by the bag's clock. At each pose that `replay` told of, too: the force on each
tool, in shares of that tool's greatest, and the sum of all. doc/runner.md tells what may differ.
To tell whether it is only which poses were followed, `replay` follows a bag of these alone: how many wrenches are
others, and how many of these were told before an update was late. Needs the build's devel/setup.bash.
Out: doc/data/replay_live.csv.
"""
import contextlib
import math
import os
import subprocess
import tempfile
import time
from pathlib import Path

import rosbag
import rospy
import yaml
from geometry_msgs.msg import WrenchStamped
from robot_tissue.msg import TissueState

from studies import moved_node
from studies.common import DATA, PACKAGE, add_programs, percentile, program, write_rows

TABLE = DATA / "replay_live.csv"
COLUMNS = ["run", "max_ms", "poses", "not_ok_percent", "compared", "force_median_percent", "force_p99_percent",
           "force_most_percent", "sum_p99_percent", "sum_most_percent", "before_late", "others_before_late",
           "others_after", "springs_cut", "load_average"]
FEW = 10.0          # Hz: replay at a tenth of the rate
ALL = 10000.0       # Hz: replay of every pose
RUNS = [(1.0, 0.0), (5.0, 0.0), (5.0, 2.0)]     # times the bag's speed, solver.max_ms
SCENE = PACKAGE / "config/demo_scene.yaml"
ROBOT = PACKAGE / "config/demo_arm.urdf"
TRAJECTORY = PACKAGE / "config/demo_trajectory.yaml"
ROUND = 27.0        # s: until the demo resets its tissue by a service, which is in no bag
CLOCK = 1000        # Hz (of the wall) of /clock: a pose is followed once a tick of it at most
QUIET = 1.0         # s without a message: the node has told all


def tool_names():
    return [tool["name"] for tool in yaml.safe_load(SCENE.read_text())["tools"]]


def record(path):
    """One round of the demo's robot, without tissue."""
    rospy.set_param("/robot_description", ROBOT.read_text())
    rospy.set_param("/robot_state_publisher/publish_frequency", 200.0)
    rospy.set_param("/demo_player/trajectory", str(TRAJECTORY))
    with contextlib.ExitStack() as stack:
        for command in (["robot_state_publisher", "robot_state_publisher"],
                        ["tf2_ros", "static_transform_publisher", *"0.10 -0.05 0 0 0 0 base_link tissue".split()],
                        ["robot_tissue", "demo_player"]):
            stack.enter_context(moved_node.running(["rosrun", *command]))
        subprocess.run(["rosbag", "record", "-O", str(path), f"--duration={ROUND:g}", "/tf", "/tf_static"], check=True)


class Told:
    """What was told of a bag: forces by tool and stamp, states."""

    def __init__(self):
        self.forces = {name: {} for name in tool_names()}
        self.states = {}
        self.last = time.monotonic()    # that something of a new pose was told

    def take(self, name, message):
        stamp = message.header.stamp.to_nsec()
        if name == "state":
            self.states[stamp] = message
        elif stamp not in self.forces[name]:
            self.last = time.monotonic()
            force = message.wrench.force
            self.forces[name][stamp] = (force.x, force.y, force.z)

    def poses(self):
        """States of updates; one of a fault has the time that it is told at."""
        return [state for state in self.states.values() if state.status not in ("NO_TRANSFORM", "STALE", "NO_ROBOT")]


def topics():
    return {f"/robot_tissue/{name}/measured_cf": (name, WrenchStamped) for name in tool_names()} | {
        "/robot_tissue/state": ("state", TissueState)}


def replayed(bag, folder, replay, *options):
    out = folder / "replayed.bag"
    subprocess.run([str(replay), str(SCENE), str(bag), str(out), "--urdf", str(ROBOT), *options], check=True)
    told = Told()
    with rosbag.Bag(str(out)) as messages:
        for topic, message, _ in messages.read_messages(topics=list(topics())):
            told.take(topics()[topic][0], message)
    return told


def only(stamps, bag, out):
    """The bag without transforms of other stamps."""
    with rosbag.Bag(str(bag)) as messages, rosbag.Bag(str(out), "w") as kept:
        for topic, message, time_of_it in messages.read_messages():
            if topic != "/tf" or message.transforms[0].header.stamp.to_nsec() in stamps:
                kept.write(topic, message, time_of_it)
    return out


def compared_at_same_poses(told, bag, folder, replay):
    """Wrenches before the first late update; of these, and after it, those that `replay` tells otherwise by a bit."""
    followed = set().union(*told.forces.values())
    same = replayed(only(followed, bag, folder / "followed.bag"), folder, replay, "--rate", f"{ALL:g}")
    late = min((stamp for stamp, state in told.states.items() if state.status in ("LATE", "TOO_FAST")),
               default=math.inf)
    before = [stamp < late for forces in told.forces.values() for stamp in forces]
    others = [stamp < late for tool, forces in told.forces.items() for stamp, force in forces.items()
              if force != same.forces[tool].get(stamp)]
    return {"before_late": sum(before), "others_before_late": sum(others), "others_after": len(others) - sum(others)}


@contextlib.contextmanager
def node_of_the_demo(max_ms):
    rospy.set_param("/use_sim_time", True)
    rospy.set_param("/robot_description", ROBOT.read_text())
    rospy.set_param("/robot_tissue", yaml.safe_load(SCENE.read_text()))
    rospy.set_param("/robot_tissue/scene_file", str(SCENE))
    rospy.set_param("/robot_tissue/solver/max_ms", max_ms)
    with moved_node.running([program("robot_tissue_node"), "__name:=robot_tissue"]):
        yield


def live(bag, speed, max_ms):
    told = Told()
    listeners = [rospy.Subscriber(topic, kind, lambda message, name=name: told.take(name, message), queue_size=10000,
                                  tcp_nodelay=True) for topic, (name, kind) in topics().items()]
    with node_of_the_demo(max_ms):
        while not told.states:      # it says that no clock or transform comes
            time.sleep(0.1)
        subprocess.run(["rosbag", "play", "--quiet", "--clock", f"--hz={CLOCK}", f"--rate={speed:g}", "--delay=2",
                        str(bag)], check=True)
        while time.monotonic() - told.last < QUIET:
            time.sleep(0.1)
    for listener in listeners:
        listener.unregister()
    return told


def length(vector):
    return sum(number * number for number in vector) ** 0.5


def differences(forces, reference):
    """Of forces at poses that both told one of, in shares of the greatest; not where both are zero."""
    greatest = max(map(length, reference.values()), default=0.0)
    both = [(forces[stamp], reference[stamp]) for stamp in forces.keys() & reference.keys()]
    return [length([a - b for a, b in zip(*pair)]) / greatest for pair in both if any(pair[0]) or any(pair[1])]


def sums_of(told):
    """Of the forces of all tools, where the tissue had come to the pose; not every pose has its state."""
    reached = set().union(*told.forces.values())
    return {stamp: (state.force_of_tools.x, state.force_of_tools.y, state.force_of_tools.z)
            for stamp, state in told.states.items() if stamp in reached}


def row_of(name, max_ms, told, reference):
    poses = told.poses()
    found = [share for tool in reference.forces for share in differences(told.forces[tool], reference.forces[tool])]
    sums = differences(sums_of(told), sums_of(reference))
    shares = {"force_median": percentile(found, 50), "force_p99": percentile(found, 99), "force_most": max(found),
              "sum_p99": percentile(sums, 99), "sum_most": max(sums),
              "not_ok": sum(state.status != "OK" for state in poses) / len(poses)}
    return {"run": name, "max_ms": f"{max_ms:g}", "poses": len(set().union(*told.forces.values())),
            "compared": len(found), "springs_cut": poses[-1].springs_cut, "load_average": f"{os.getloadavg()[0]:.1f}",
            **{share + "_percent": f"{100.0 * value:.2f}" for share, value in shares.items()}}


def add_arguments(parser):
    parser.add_argument("--bag", type=Path, help="instead of one that is recorded first")
    parser.add_argument("--table", type=Path, default=TABLE, help="where it is written")
    add_programs(parser)


def run(options):
    replay = program("replay", options.programs)
    with tempfile.TemporaryDirectory() as folder, moved_node.own_master("replay_live"):
        bag = options.bag or Path(folder) / "demo.bag"
        if not options.bag:
            record(bag)
        reference = replayed(bag, Path(folder), replay)
        few = replayed(bag, Path(folder), replay, "--rate", f"{FEW:g}")
        rows = [row_of("replay", 0.0, reference, reference), row_of(f"replay --rate {FEW:g}", 0.0, few, reference)]
        for speed, max_ms in RUNS:
            told = live(bag, speed, max_ms)
            rows.append(row_of(f"live, {speed:g} times", max_ms, told, reference) |
                        compared_at_same_poses(told, bag, Path(folder), replay))
    write_rows(options.table, COLUMNS, rows)
    for row in rows:
        print(" ".join(f"{name}={row.get(name, '')}" for name in COLUMNS))
