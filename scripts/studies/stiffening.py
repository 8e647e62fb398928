"""Measures the law fung: a press by 30 % of the height, by every method against a fine lattice.

A patch of 20 x 20 mm presses a block of 100 x 100 x 50 mm by 15 mm, with several exponents. Forces at 10 and 5 mm are
held against those of `newton` at 10/3 mm. Out: doc/data/stiffening.csv.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

from studies.common import (DATA, add_plot, add_programs, numbers, print_rows, program, progress,
                            rows_of, worst, write_rows)

TABLE = DATA / "stiffening.csv"
METHODS = ["layered", "newton", "vbd", "xpbd", "explicit"]
EXPONENTS = [0, 2, 10]
FINE = 0.01 / 3.0
DEPTH = 0.015


def scene(method, spacing, exponent):
    punch = {"name": "punch", "min": [0.04, 0.04, 0.05], "max": [0.06, 0.06, 0.05],
             "displacement": [0, 0, -DEPTH]}
    return {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.05]},
                       "spacing": spacing,
                       "material": {"young_modulus": 1e4, "poisson_ratio": 0.45, "law": "fung",
                                    "stiffening": exponent},
                       "fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}]},
            "solver": {"method": method}, "steps": [{"load": {"patches": [punch]}}]}


def press(simulate, method, spacing, exponent):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(yaml.safe_dump(scene(method, spacing, exponent)))
        done = subprocess.run([simulate, file, "--out", folder, "--quiet"], capture_output=True,
                              text=True, check=False)
        if done.returncode not in (0, 3):
            sys.exit("stiffening: " + done.stderr.strip())
        force = -float(rows_of(Path(folder) / "patches.csv")[-1]["fz"])
        rows = rows_of(Path(folder) / "increments.csv")
    return force, worst(rows), sum(numbers(rows, "wall_ms"))


def measure(simulate):
    table = []
    for exponent in progress(EXPONENTS, str):
        fine, _, _ = press(simulate, "newton", FINE, exponent)
        for spacing in (0.01, 0.005):
            exact = press(simulate, "newton", spacing, exponent)[0]
            for method in METHODS:
                force, status, ms = press(simulate, method, spacing, exponent)
                table.append({"stiffening": exponent, "spacing_m": spacing, "method": method,
                              "status": status, "force_N": f"{force:.4g}",
                              "off_newton_percent": f"{100.0 * (force / exact - 1.0):.3g}",
                              "off_fine_percent": f"{100.0 * (force / fine - 1.0):.3g}",
                              "ms": f"{ms:.3g}"})
    write_rows(TABLE, list(table[0]), table)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(program("simulate", options.programs))
    print_rows(rows_of(TABLE))
