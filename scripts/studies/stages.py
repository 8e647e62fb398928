"""Measures what share of an update in contact each stage of the line takes, by samples of `perf`.

Runs the benchmark `tool_speed` (a sphere, or an ellipsoid of 2,000 triangles, pressed 5 mm into a
block and drawn round on it) in one thread and puts each sample within Pipeline::step to the last
of STAGES that a function on its stack belongs to. Needs perf (Debian's package linux-perf) and a
build whose stacks it can read:
    cmake -DCMAKE_CXX_FLAGS=-fno-omit-frame-pointer ... && make tool_speed
Writes doc/data/stages.csv, draws doc/images/stages.png, prints a table. --plot draws and prints
only.
"""

import collections
import csv
import io
import re
import shutil
import subprocess
import sys
import tempfile

from studies.common import (DATA, IMAGES, add_plot, add_programs, program, progress, pyplot,
                            rows_of, write_rows)

TABLE = DATA / "stages.csv"
PLOT = IMAGES / "stages.png"
# Tool, spacing (mm) of 100 x 100 x 50 mm, nodes, updates.
JOBS = [("sphere", 5.0, 4851, 600), ("sphere", 2.5, 35301, 300), ("mesh", 5.0, 4851, 400)]
SPEED, RATE = 0.05, 200.0  # m/s, updates a second
UPDATE = "robot_tissue::Pipeline::step\n"
# The line's order. HEAP: samples in the C library, which has no frame pointers.
HEAP = ("memory of the heap", r"malloc|free|_int_|calloc|realloc|unlink_chunk")
STAGES = [
    ("the tools' way", UPDATE),
    ("bookkeeping of contact",
     r"SlidingContacts::|TouchFinder::|ToolContactUpdate::|LoadStepper::meet|patchesOfTools|"
     r"Tissue::(solve|limitWays|goBack|putToolPatches)"),
    ("contact search", r"ContactFinder::|LinkContacts::|AabbTree"),
    ("surface, volume, inverted cells",
     r"Tissue::(deformSurface|describeShape|volumeRatio)\n|robot_tissue::deform\n"),
    ("sums, search and errors of the solve",
     r"(FasCg\w+|ErrorEstimator|ForceBalance|OpenPart|WarmStart|CompositeShape)<\w+>::|"
     r"searchLine|SolveProgress|GridHierarchy<\w+>::|CoarseCorrection<\w+>::|"
     r"MultigridSolver|LayeredMethod::|DofConstraints::"),
    ("finest lattice: patches, steps", r"GridLevel<\w+>::|ConstrainedNodes<\w+>::|::stepAlong\n"),
    ("finest lattice: forces of cells", r"CellOperator<\w+>::(find|add|finish)"),
    ("coarse lattices: beyond the part", r"UncoveredPart<\w+>::"),
    ("coarse lattices: smooth motion", r"CoarseCorrection<\w+>::find\n"),
    ("parts opened, patches bound, shape written",
     r"(CompositeGrid|GridHierarchy)<\w+>::open|LevelConstraints<\w+>::|"
     r"NodeDisplacements<\w+>::(take|write)"),
    ("reports", r"describeTool"),
    HEAP,
]


def output_of(command):
    try:
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True,
                              universal_newlines=True).stdout
    except subprocess.CalledProcessError as error:
        said = error.stderr.strip().splitlines() or ["no word why"]
        sys.exit(f"stages: `{' '.join(command[:2])}` failed: {said[-1]}")


def stage_of(stack):
    """None: of no update, as what loads the program."""
    if UPDATE not in stack + "\n":
        lost = "robot_tissue::" not in stack and re.search(HEAP[1], stack.split("\n", 2)[0])
        return HEAP[0] if lost else None
    return next(stage for stage, names in reversed(STAGES[:-1]) if re.search(names, stack + "\n"))


def profile(built, job, rate):
    """Samples of each stage; processor ms of an update in the mean, of a run without perf."""
    tool, spacing, _, updates = job
    command = [str(word) for word in (built, tool, SPEED, RATE, updates, spacing)]
    table = output_of(command)
    with tempfile.TemporaryDirectory() as folder:
        data = f"{folder}/perf.data"
        output_of(["perf", "record", "-F", str(rate), "-e", "cpu-clock", "--call-graph", "fp", "-o", data,
             "--", *command])
        stacks = output_of(["perf", "script", "-i", data, "--no-inline", "-F", "ip,sym"]).split("\n\n")
    times = [float(row["update_ms"]) for row in csv.DictReader(io.StringIO(table))]
    samples = collections.Counter(stage_of(stack.strip()) for stack in stacks if stack.strip())
    if samples[STAGES[0][0]] == 0:
        sys.exit("stages: no stack has Pipeline::step on it; the build needs "
                 "-DCMAKE_CXX_FLAGS=-fno-omit-frame-pointer")
    return samples, sum(times) / len(times)


def measure(built, rounds, rate):
    runs = collections.defaultdict(list)
    for _ in progress(range(rounds), lambda round: f"round {round + 1}"):
        for job in JOBS:
            runs[job].append(profile(built, job, rate))
    rows = []
    for (tool, spacing, nodes, _), each in runs.items():
        ms = sorted(ms for _, ms in each)[len(each) // 2]
        totals = [sum(samples[stage] for stage, _ in STAGES) for samples, _ in each]
        left_out = sum(samples[None] for samples, _ in each)
        for stage, _ in STAGES:
            shares = [samples[stage] / total for (samples, _), total in zip(each, totals)]
            share = sum(samples[stage] for samples, _ in each) / sum(totals)
            rows.append({"tool": tool, "spacing_mm": spacing, "nodes": nodes, "stage": stage,
                         "share": f"{share:.4f}", "share_least": f"{min(shares):.4f}",
                         "share_most": f"{max(shares):.4f}", "ms": f"{share * ms:.4f}",
                         "samples": sum(totals), "samples_left_out": left_out})
    write_rows(TABLE, rows[0].keys(), rows)


def jobs_of_table():
    rows = rows_of(TABLE)
    for tool, spacing, nodes, _ in JOBS:
        yield (f"{tool}, {nodes:,} nodes",
               [row for row in rows if (row["tool"], float(row["spacing_mm"])) == (tool, spacing)])


def draw():
    plt = pyplot()
    jobs = list(jobs_of_table())
    figure, axes = plt.subplots(figsize=(8, 3.8))
    colors = plt.get_cmap("tab20").colors[1:]
    for place, (_, rows) in enumerate(jobs):
        left = 0.0
        for row, color in zip(rows, colors):
            share = 100.0 * float(row["share"])
            axes.barh(place, share, left=left, color=color, edgecolor="white",
                      label=row["stage"] if place == 0 else None)
            if share >= 4.0:
                axes.text(left + share / 2, place, f"{share:.0f}", ha="center", va="center",
                          fontsize=8)
            left += share
    axes.set_yticks(range(len(jobs)))
    axes.set_yticklabels([f"{name}\n{sum(float(row['ms']) for row in rows):.1f} ms"
                          for name, rows in jobs])
    axes.invert_yaxis()
    axes.set_xlim(0.0, 100.0)
    axes.set_xlabel("% of the processor time of an update")
    figure.legend(loc="upper center", ncol=3, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.79))
    figure.savefig(PLOT, dpi=110)


def tell():
    jobs = list(jobs_of_table())
    print("| stage | " + " | ".join(name for name, _ in jobs) + " |")
    print("|---" * (len(jobs) + 1) + "|")
    for number, (stage, _) in enumerate(STAGES):
        cells = (f"{100 * float(rows[number]['share']):.1f} %, {float(rows[number]['ms']):.2g} ms"
                 for _, rows in jobs)
        print(f"| {stage} | " + " | ".join(cells) + " |")
    for name, rows in jobs:
        widest = max(float(row["share_most"]) - float(row["share_least"]) for row in rows)
        print(f"{name}: {rows[0]['samples']} samples, {rows[0]['samples_left_out']} more "
              f"of no update; shares of the runs at most {100 * widest:.1f} % apart")


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--samples", type=int, default=5000, help="a second (5000)")


def run(options):
    if not options.plot:
        if shutil.which("perf") is None:
            sys.exit("stages: `perf` is not there; it is in Debian's package linux-perf")
        measure(program("tool_speed", options.programs), options.rounds, options.samples)
    draw()
    tell()
