"""Runs every method through rungs of motion in time: a jerk, a stiff inclusion, a shake.

A jerk of 10 g on a block that was at rest, and a bar with an inclusion that is a thousand times stiffer, let go: in
increments of 1 to 50 ms, which bound the steps. A sphere that presses a block and shakes at 100 Hz. A rung is held when
all numbers are finite, every increment is OK and what is measured is within its bound of `newton`'s in the shortest
increments. Out: doc/data/time_stability.csv.
"""

import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml

from studies.common import (DATA, add_plot, add_programs, print_rows, program, progress, rows_of,
                            worst, write_rows)

TABLE = DATA / "time_stability.csv"
METHODS = ["layered", "newton", "vbd", "xpbd", "explicit"]
INCREMENTS = [0.001, 0.005, 0.02, 0.05]  # s
BOUND = 0.05                             # of the greatest
LIMIT = 300                              # s, of a run
FREE = "free"


def tissue(size, more):
    return {"shape": {"type": "box", "min": [0, 0, 0], "max": size}, "spacing": 0.01,
            "material": {"young_modulus": 1e4, "poisson_ratio": 0.45},
            "time": {"damping_time": 0.005}, **more}


def point(name, place):
    return {"name": name, "min": place, "max": place, "displacement": [FREE, 0, FREE]}


def waits(duration, increment):
    return {"wait": {"duration": duration, "increments": max(1, round(duration / increment))}}


def jerk(increment):
    more = {"fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}], "gravity": [0, 0, -98.1]}
    return {"tissue": tissue([0.06, 0.06, 0.04], more),
            "steps": [waits(0.5, increment)]}, "nodes"


def inclusion(increment):
    more = {"fixed": [{"min": [-1, -1, -1], "max": [1e-6, 1, 1]}],
            "regions": [{"min": [0.06, 0.0, 0.0], "max": [0.1, 0.03, 0.02], "young_modulus": 1e7}]}
    bent = {"name": "bent", "min": [0.16, 0, 0], "max": [0.16, 0.04, 0.04],
            "displacement": [FREE, FREE, -0.02]}
    return {"tissue": tissue([0.16, 0.04, 0.04], more),
            "steps": [{"load": {"patches": [bent]}}, {"release": {"patches": ["bent"]}},
                      waits(0.2, increment)]}, "nodes"


def shake(_):
    more = {"fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}]}
    def at(depth):
        return {"xyz": [0.03, 0.03, 0.05 - depth]}
    steps = [{"move": {"tool": "probe", "from": at(-0.001), "to": at(0.003), "duration": 0.1,
                       "increments": 20}}]
    for i in range(20):
        steps.append({"move": {"tool": "probe", "to": at(0.003 + (0.0005 if i % 2 else -0.0005)),
                               "duration": 0.005, "increments": 5}})
    return {"tissue": tissue([0.06, 0.06, 0.04], more),
            "tools": [{"name": "probe", "friction": 0.0,
                       "shapes": [{"type": "sphere", "radius": 0.01}]}],
            "steps": steps}, "tools"


RUNGS = [(name, make, increment) for name, make in (("jerk of 10 g", jerk),
                                                    ("stiff inclusion", inclusion))
         for increment in INCREMENTS] + [("shake at 100 Hz", shake, 0.001)]


def run_scene(simulate, scene, method, what):
    """Status, share of increments that are not OK, what was measured, seconds; None: no result."""
    scene = {**scene, "solver": {"method": method}}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(yaml.safe_dump(scene))
        start = time.monotonic()
        try:
            done = subprocess.run([simulate, file, "--out", folder, "--quiet"], timeout=LIMIT,
                                  capture_output=True, text=True, check=False)
        except subprocess.TimeoutExpired:
            return None
        if done.returncode not in (0, 3):
            return None
        rows = rows_of(Path(folder) / "increments.csv")
        if what == "nodes":
            table, columns = rows_of(Path(folder) / "nodes.csv"), ("ux", "uy", "uz")
        else:
            table, columns = rows_of(Path(folder) / "tools.csv"), ("fx", "fy", "fz")
        values = np.array([[float(row[column]) for column in columns] for row in table])
    bad = np.mean([row["status"] != "OK" for row in rows])
    return worst(rows), bad, values, time.monotonic() - start


def measure(simulate):
    table, references = [], {}
    jobs = [(rung, method) for rung in RUNGS for method in METHODS]
    for (name, make, increment), method in progress(jobs, lambda job: f"{job[0][0]} {job[1]}"):
        if name not in references:
            scene, what = make(min(INCREMENTS))
            references[name] = run_scene(simulate, scene, "newton", what)[2]
        scene, what = make(increment)
        right = references[name]
        row = {"rung": name, "increment_ms": f"{1e3 * increment:g}", "method": method}
        result = run_scene(simulate, scene, method, what)
        if result is None:
            table.append({**row, "verdict": "no result"})
            continue
        status, bad, values, seconds = result
        off = np.linalg.norm(values - right, axis=1).max() / np.linalg.norm(right, axis=1).max()
        held = status == "OK" and np.isfinite(off) and off <= BOUND
        table.append({**row, "verdict": "held" if held else "failed", "status": status,
                      "not_ok_percent": f"{100.0 * bad:.3g}", "off_percent": f"{100.0 * off:.3g}",
                      "seconds": f"{seconds:.3g}"})
    columns = ["rung", "increment_ms", "method", "verdict", "status", "not_ok_percent",
               "off_percent", "seconds"]
    write_rows(TABLE, columns, table)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(program("simulate", options.programs))
    print_rows(rows_of(TABLE))
