"""Measures speed against accuracy in time: a swing by every method, against a fine solution.

A bar of 200 x 40 x 40 mm, held at one end, is bent and let go. Its tip and the force that holds it are compared, every
5 ms, with those of `newton` in steps of a quarter of a millisecond: root mean square over the swing, over the greatest.
Out: doc/data/swing.csv, doc/images/swing.png.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies.common import (DATA, IMAGES, add_plot, add_programs, numbers, print_rows, program,
                            progress, pyplot, rows_of, worst, write_rows)

TABLE = DATA / "swing.csv"
METHODS = ["layered", "newton", "vbd", "xpbd", "explicit"]
TOLERANCES = [0.1, 0.03, 0.01, 0.003, 0.001]
LENGTH, THICK, CELLS, DURATION, INTERVAL = 0.2, 0.04, 4, 0.4, 0.005
FINE_STEPS = 20                 # in an interval
FREE = "free"


def patch(name, place, way):
    return {"name": name, "min": [place, 0, 0], "max": [place, THICK, THICK], "displacement": way}


def scene(method, tolerance, intervals):
    tip = {"name": "tip", "min": [LENGTH, THICK / 2, THICK / 2],
           "max": [LENGTH, THICK / 2, THICK / 2], "displacement": [FREE, 0, FREE]}
    return {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [LENGTH, THICK, THICK]},
                       "spacing": THICK / CELLS,
                       "material": {"young_modulus": 1e5, "poisson_ratio": 0.4},
                       "time": {"damping_time": 0.002}},
            "solver": {"method": method, "tolerance": tolerance},
            "steps": [{"load": {"patches": [patch("held", 0.0, [0, 0, 0]), tip,
                                            patch("bent", LENGTH - THICK / CELLS,
                                                  [FREE, FREE, -0.02])]}},
                      {"release": {"patches": ["bent"]}},
                      {"wait": {"duration": DURATION, "increments": intervals}}]}


def swing(simulate, method, tolerance, intervals):
    """Tip (m), force that holds (N), rows of the increments; every INTERVAL."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(yaml.safe_dump(scene(method, tolerance, intervals)))
        done = subprocess.run([simulate, file, "--out", folder, "--quiet"], capture_output=True,
                              text=True)
        if done.returncode not in (0, 3):
            sys.exit("swing: " + done.stderr.strip())
        patches = [row for row in rows_of(Path(folder) / "patches.csv") if row["step"] == "2"]
        rows = [row for row in rows_of(Path(folder) / "increments.csv") if row["step"] == "2"]
    every = intervals // round(DURATION / INTERVAL)
    tip = np.array([float(row["uz"]) for row in patches if row["patch"] == "tip"])
    held = np.array([[float(row[axis]) for axis in ("fx", "fy", "fz")]
                     for row in patches if row["patch"] == "held"])
    return tip[every - 1::every], held[every - 1::every], rows


def off(values, right):
    """Percent."""
    apart = np.linalg.norm((values - right).reshape(len(right), -1), axis=1)
    greatest = np.linalg.norm(right.reshape(len(right), -1), axis=1).max()
    return 100.0 * np.sqrt(np.mean(apart ** 2)) / greatest


def measure(simulate):
    intervals = round(DURATION / INTERVAL)
    tip, held, _ = swing(simulate, "newton", 1e-3, FINE_STEPS * intervals)
    table = []
    jobs = [(method, tolerance) for method in METHODS for tolerance in TOLERANCES]
    for method, tolerance in progress(jobs, lambda job: f"{job[0]} {job[1]}"):
        of_tip, of_held, rows = swing(simulate, method, tolerance, intervals)
        table.append({"method": method, "tolerance": tolerance, "status": worst(rows),
                      "not_ok_percent": f"{100.0 * np.mean([row['status'] != 'OK' for row in rows]):.3g}",
                      "ms_a_simulated_ms":
                          f"{sum(numbers(rows, 'update_ms')) / (1e3 * DURATION):.3g}",
                      "tip_percent": f"{off(of_tip, tip):.3g}",
                      "force_percent": f"{off(of_held, held):.3g}"})
    write_rows(TABLE, list(table[0]), table)


def draw():
    plt = pyplot()
    figure, both = plt.subplots(1, 2, figsize=(9, 3.6), sharex=True)
    rows = rows_of(TABLE)
    for axes, column, title in zip(both, ("tip_percent", "force_percent"),
                                   ("place of the tip", "force that holds the bar")):
        for method in METHODS:
            picked = [row for row in rows if row["method"] == method]
            axes.loglog(numbers(picked, "ms_a_simulated_ms"), numbers(picked, column), "o-",
                        label=method, markersize=3, linewidth=1.0)
        axes.set(xlabel="ms a simulated ms", ylabel="rms error (% of the greatest)", title=title)
        axes.grid(True, which="major", linewidth=0.3)
    both[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(IMAGES / "swing.png", dpi=120)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(program("simulate", options.programs))
    draw()
    print_rows(rows_of(TABLE))
