"""Drags tools over tissue that moves in time, by every method: cost, and how far forces are from newton's.

A sphere, a box on its face, one on its edge and a needle over a block of 11 x 11 x 6 nodes, damped by 10 ms: pressed in
by 5 mm, dragged by 25 mm at 20 mm/s, 200 poses a second. Out: doc/data/time_tools.csv.
"""

import time
from pathlib import Path

import numpy as np

from studies.common import (DATA, add_plot, add_programs, print_rows, program, progress, rows_of,
                            worst, write_rows)
from studies.motion import TOOLS, drag_scene, simulated

TABLE = DATA / "time_tools.csv"
METHODS = ["newton", "layered", "vbd", "xpbd", "explicit"]
TOLERANCES = [0.01, 0.001]
SPACING, DAMPING_TIME = 0.01, 0.01
MORE_TOOLS = {"box, face": ({"type": "box", "size": [0.02, 0.02, 0.02]}, 0.01),
              "needle": ({"type": "cylinder", "radius": 0.0005, "length": 0.06}, 0.03)}


def forces_of(simulate, tool, method, tolerance):
    """Worst status, forces on the tool at its poses (N), s of the processor's clock on the wall."""
    shape, height = {**TOOLS, **MORE_TOOLS}[tool]
    scene = drag_scene(shape, height, SPACING, DAMPING_TIME)
    scene["solver"] = {"method": method}
    if method != "newton":
        scene["solver"]["tolerance"] = tolerance
    start = time.monotonic()
    with simulated(simulate, scene) as folder:
        seconds = time.monotonic() - start
        rows = rows_of(Path(folder) / "increments.csv")
        forces = np.array([[float(row[axis]) for axis in ("fx", "fy", "fz")]
                           for row in rows_of(Path(folder) / "tools.csv")])
    return worst(rows), forces, seconds


def measure(simulate):
    table = []
    for tool in progress(list({**TOOLS, **MORE_TOOLS}), str):
        right = None
        for method in METHODS:
            for tolerance in TOLERANCES[:1] if method in ("newton", "explicit") else TOLERANCES:
                status, forces, seconds = forces_of(simulate, tool, method, tolerance)
                right = forces if right is None else right
                off = np.linalg.norm(forces - right, axis=1) / np.linalg.norm(right, axis=1).max()
                table.append({"tool": tool, "method": method,
                              "tolerance": "" if method in ("newton", "explicit") else tolerance,
                              "status": status, "ms_a_pose": f"{1e3 * seconds / len(forces):.3g}",
                              "rms_off_percent": f"{100.0 * np.sqrt((off ** 2).mean()):.3g}",
                              "greatest_off_percent": f"{100.0 * off.max():.3g}"})
    write_rows(TABLE, list(table[0]), table)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(program("simulate", options.programs))
    print_rows(rows_of(TABLE))
