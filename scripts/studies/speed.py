"""Measures how long an increment takes for how small an error, with every method on `elastic`.

Runs the benchmark `speed` (make speed), press of 5 x 1 mm, and keeps its medians in
doc/data/speed.csv: a row a size, Poisson's ratio, method and tolerance. All methods of a size run in
turn, so that what else the machine does meets all. Draws doc/images/speed.png and prints which
method takes how many times as long as `layered` for 5, 1 and 0.1 %. --plot draws and prints only.
The exact shapes, which take longest, are kept in --cache.
"""

import csv
import io
import statistics
import subprocess
from pathlib import Path

from studies.common import (DATA, IMAGES, add_plot, add_programs, program, progress, pyplot,
                            rows_of, write_rows)

TABLE = DATA / "speed.csv"
PLOT = IMAGES / "speed.png"
COLUMNS = ["nodes", "poisson_ratio", "method", "tolerance", "median_ms", "least_ms", "greatest_error",
           "mean_iterations", "increments"]
TOLERANCES = {"layered": (0.1, 0.04, 0.01, 0.004, 0.001, 0.0002), "vbd": (0.1, 0.04, 0.01, 0.002),
              "vbd_chebyshev": (0.1, 0.04, 0.01, 0.002), "explicit": (0.1, 0.04, 0.01, 0.002),
              "xpbd": (0.1, 0.02)}
BOUNDS = (0.05, 0.01, 0.001)


def measure(built, spacing, ratio, cache, repeats):
    jobs = [f"{method}:{','.join(map(str, each))}" for method, each in TOLERANCES.items()]
    command = [str(built), "press", str(spacing), str(ratio), str(cache), str(repeats)] + jobs
    done = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True, check=True)
    runs = {}
    for row in csv.DictReader(io.StringIO(done.stdout)):
        runs.setdefault((row["nodes"], row["nu"], row["method"], row["tolerance"]), []).append(row)
    for key, rows in runs.items():
        times = [float(row["ms"]) for row in rows]
        yield dict(zip(COLUMNS, [*key, f"{statistics.median(times):.4g}", f"{min(times):.4g}",
                                 f"{max(float(row['error']) for row in rows):.3g}",
                                 f"{statistics.mean(float(r['iterations']) for r in rows):.1f}",
                                 len(rows)]))


def least_time(rows, bound):
    times = [float(row["median_ms"]) for row in rows if float(row["greatest_error"]) <= bound]
    return min(times) if times else None


def groups(rows):
    return sorted({(int(row["nodes"]), float(row["poisson_ratio"])) for row in rows})


def draw(rows):
    plt = pyplot()
    shown = groups(rows)
    figure, panels = plt.subplots(1, len(shown), figsize=(4.2 * len(shown), 4), squeeze=False)
    for panel, (nodes, ratio) in zip(panels[0], shown):
        for method in TOLERANCES:
            line = [row for row in rows if row["method"] == method and int(row["nodes"]) == nodes
                    and float(row["poisson_ratio"]) == ratio]
            panel.plot([100.0 * float(row["greatest_error"]) for row in line],
                       [float(row["median_ms"]) for row in line], "o-", label=method)
        panel.set(xscale="log", yscale="log", xlabel="greatest true error of five increments (%)",
                  ylabel="median ms an increment of 1 mm",
                  title=f"{nodes} nodes, Poisson's ratio {ratio:g}")
        panel.grid(True, which="both", alpha=0.3)
    panels[0][0].legend()
    figure.tight_layout()
    figure.savefig(PLOT, dpi=100)


def tell(rows):
    print("nodes, Poisson's ratio, error: layered (ms), others over layered")
    for nodes, ratio in groups(rows):
        here = [row for row in rows if int(row["nodes"]) == nodes
                and float(row["poisson_ratio"]) == ratio]
        for bound in BOUNDS:
            times = {method: least_time([r for r in here if r["method"] == method], bound)
                     for method in TOLERANCES}
            if times["layered"] is None:
                continue
            others = ", ".join(f"{method} " + ("-" if time is None else
                                               f"{time / times['layered']:.1f}")
                               for method, time in times.items() if method != "layered")
            print(f"{nodes}, {ratio:g}, {100 * bound:g} %: {times['layered']:.3g}; {others}")


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)
    parser.add_argument("--cache", type=Path, default=Path("/tmp/robot_tissue_speed"))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--spacings", type=float, nargs="+", default=[0.01, 0.005, 0.0025])


def run(options):
    if not options.plot:
        built = program("speed", options.programs)
        options.cache.mkdir(parents=True, exist_ok=True)
        jobs = [(spacing, ratio) for spacing in options.spacings for ratio in (0.25, 0.45)]
        rows = []
        for spacing, ratio in progress(jobs):
            rows += measure(built, spacing, ratio, options.cache, options.repeats)
            write_rows(TABLE, COLUMNS, rows)
    rows = rows_of(TABLE)
    draw(rows)
    tell(rows)
