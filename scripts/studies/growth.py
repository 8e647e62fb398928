"""Measures what an increment of `layered` takes, and needs of memory, as the lattice grows.

Runs the benchmark `growth` (make growth): one block at finer and finer spacings, and larger and
larger blocks at one spacing. All jobs in turn, so that what else the machine does meets all; medians
of the rounds. Larger blocks also right between two runs of the block of 4,851 nodes: medians of the
ratios. Writes doc/data/growth.csv, draws doc/images/growth.png, prints a table. --plot draws
and prints only.
"""

import csv
import io
import statistics
import subprocess

from studies.common import (DATA, IMAGES, add_plot, add_programs, program, progress, pyplot,
                            rows_of, write_rows)

TABLE = DATA / "growth.csv"
PLOT = IMAGES / "growth.png"
# Spacing (m), times the sides of 100 x 100 x 50 mm, tolerance, threads.
FINER = [(0.01, 1, 0.01, 1), (0.005, 1, 0.01, 1), (0.0025, 1, 0.01, 1), (0.00125, 1, 0.01, 1)]
LARGER = [(0.005, 1, 0.01, 1), (0.005, 2, 0.01, 1), (0.005, 4, 0.01, 1)]
ROUGHER = [(0.005, 1, 0.02, 1), (0.005, 2, 0.02, 1), (0.005, 4, 0.02, 1)]
THREADS = [(0.00125, 1, 0.01, 2)]
RATIOS = (0.25, 0.45)
TIMES = ("processor_ms", "processor_90_ms", "wall_ms")


def run_once(built, job, ratio, repeats, *more):
    spacing, scale, tolerance, threads = job
    command = [str(built)] + [str(x) for x in (spacing, scale, ratio, tolerance, threads, repeats)]
    done = subprocess.run(command + list(more), stdout=subprocess.PIPE, universal_newlines=True,
                          check=True)
    return next(csv.DictReader(io.StringIO(done.stdout)))


def times_of_least(built, jobs, job, ratio, repeats):
    """The job's time over that of the first one, measured just before it and after."""
    before, here, after = (float(run_once(built, each, ratio, repeats)["processor_ms"])
                           for each in (jobs[0], job, jobs[0]))
    return here / (0.5 * (before + after))


def measure(built, rounds, repeats):
    jobs = list(dict.fromkeys(FINER + LARGER + ROUGHER + THREADS))
    runs = {}
    for _ in progress(range(rounds), lambda round: f"round {round + 1}"):
        for ratio in RATIOS:
            for job in jobs:
                runs.setdefault((job, ratio), []).append(run_once(built, job, ratio, repeats))
    rows = []
    for (job, ratio), each in progress(runs.items(), lambda one: f"ratios of {one[0]}"):
        row = dict(zip(("spacing_m", "scale", "tolerance", "threads"), job), poisson_ratio=ratio)
        row.update(each[0])
        row.update({key: f"{statistics.median(float(one[key]) for one in each):.4g}"
                    for key in TIMES})
        jobs = ROUGHER if job in ROUGHER else LARGER
        row["times_of_4851"] = "" if job not in jobs else format(statistics.median(
            times_of_least(built, jobs, job, ratio, repeats) for _ in range(rounds)), ".3g")
        row["greatest_error"] = run_once(built, job, ratio, 1, "error")["greatest_error"]
        rows.append(row)
    write_rows(TABLE, rows[0].keys(), rows)


def rows_of_jobs(jobs, ratio):
    rows = rows_of(TABLE)
    keys = ("spacing_m", "scale", "tolerance", "threads")
    return [row for job in jobs for row in rows
            if tuple(float(row[key]) for key in keys) == tuple(map(float, job))
            and float(row["poisson_ratio"]) == ratio]


def draw():
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for jobs, name, style in ((FINER, "finer, 1 %", "o-"), (LARGER, "larger, 1 %", "s--"),
                              (ROUGHER, "larger, 2 %", "^:")):
        for ratio, color in zip(RATIOS, ("tab:red", "tab:blue")):
            rows = rows_of_jobs(jobs, ratio)
            axes.loglog([int(row["nodes"]) for row in rows],
                        [float(row["processor_ms"]) for row in rows], style, color=color,
                        label=f"{name}, nu {ratio}")
    axes.set_xlabel("nodes of the lattice")
    axes.set_ylabel("processor ms per 1 mm increment, median")
    axes.grid(True, which="major", alpha=0.4)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(PLOT, dpi=110)


def tell():
    print("| nodes | spacing | block | tolerance | threads | nu | processor ms, 90 % | ms | "
          "greatest error | nodes visited | bytes a node |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for job in dict.fromkeys(FINER + LARGER + ROUGHER + THREADS):
        for ratio in RATIOS:
            for row in rows_of_jobs([job], ratio):
                print(f"| {int(row['nodes']):,} | {1e3 * float(row['spacing_m']):g} mm "
                      f"| x {row['scale']} | {float(row['tolerance']):g} | {row['threads']} | {ratio} "
                      f"| {float(row['processor_ms']):.3g}, {float(row['processor_90_ms']):.3g} "
                      f"| {float(row['wall_ms']):.3g} | {100 * float(row['greatest_error']):.2g} % "
                      f"| {int(row['active_nodes']):,} | {row['bytes_a_node']} |")
    for jobs, name in ((LARGER, "1 %"), (ROUGHER, "2 %")):
        for ratio in RATIOS:
            rows = rows_of_jobs(jobs, ratio)
            print(f"growth at {name}, nu {ratio}: {rows[-1]['times_of_4851']} times the time for "
                  f"{int(rows[-1]['nodes']) / int(rows[0]['nodes']):.0f} times the nodes")


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--repeats", type=int, default=5, help="of a job in a round (5)")


def run(options):
    if not options.plot:
        measure(program("growth", options.programs), options.rounds, options.repeats)
    draw()
    tell()
