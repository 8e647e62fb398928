"""Measures speed against accuracy of a tool: pressed and dragged, by every method that has contact, at three sizes.

A sphere of 10 mm and a box on its edge go 8 mm into a block of 100 x 100 x 50 mm and 20 mm along it, 0.5 mm an update,
friction 0.3. Forces at the updates, and the last shape at nodes 10 mm apart, are held against those of a lattice of
5/3 mm, for the edge of 2 mm (`layered` at 1e-2). With Bullet's deformable solver, where bullet_tool is built: a way of
0.5 mm takes a sixtieth of a second, in more or fewer steps (column `steps`).
What takes more than half a second an update, Bullet's more than five, is left out.
Out: doc/data/tool_accuracy.csv, doc/images/tool_accuracy.png.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies.common import (DATA, IMAGES, add_plot, add_programs, numbers, percentile, print_rows,
                            program, progress, pyplot, rows_of, worst, write_rows)

TABLE, CHART = DATA / "tool_accuracy.csv", IMAGES / "tool_accuracy.png"
SPACINGS = [0.01, 0.005, 0.0025]
FINE = {"sphere": 0.005 / 3.0, "edge": 0.002}
COARSEST = 0.01                # nodes of all lattices
METHODS = {"layered": [0.1, 0.01, 0.001], "vbd": [0.1, 0.01, 0.001], "xpbd": [0.1, 0.01],
           "explicit": [0.1, 0.01], "newton": [None]}
BULLET = {"bullet": [32, 64, 128], "bullet_implicit": [16, 64]}    # steps an update
TOOLS = {"sphere": ({"type": "sphere", "radius": 0.01}, 0.01),
         "edge": ({"type": "box", "size": [0.02, 0.02, 0.02], "rpy": [0, math.pi / 4, 0]},
                  0.01 * math.sqrt(2.0))}
LIMIT, BULLETS_LIMIT = 30, 280    # s, of a run: half a second, and five, an update
COLORS = {"layered": "tab:red", "newton": "tab:blue", "vbd": "tab:green", "xpbd": "tab:orange",
          "explicit": "tab:purple", "bullet": "tab:gray", "bullet_implicit": "black"}


def scene(tool, spacing, method, tolerance):
    shape, height = TOOLS[tool]

    def there(x, depth):
        return {"xyz": [x, 0.05, 0.05 + height - depth]}
    solver = {"method": method}
    if tolerance is not None:
        solver["tolerance"] = tolerance
    return {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.05]},
                       "spacing": spacing,
                       "material": {"young_modulus": 1e4, "poisson_ratio": 0.45},
                       "fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}]},
            "solver": solver,
            "tools": [{"name": "tool", "friction": 0.3, "shapes": [shape]}],
            "steps": [{"move": {"tool": "tool", "from": there(0.04, 0.0), "to": there(0.04, 0.008),
                                "increments": 16}},
                      {"move": {"tool": "tool", "to": there(0.06, 0.008), "increments": 40}}]}


class Run:
    """Forces (N) per update, displacement at the common nodes (m), ms per update."""

    def __init__(self, command, tool_scene, limit=LIMIT):
        self.ok = False
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.yaml"
            file.write_text(yaml.safe_dump(tool_scene))
            try:
                done = subprocess.run([*command, file, "--out", folder, "--quiet"], timeout=limit,
                                      capture_output=True, text=True, check=False)
            except subprocess.TimeoutExpired:
                self.status = "TIMED_OUT"
                return
            if done.returncode not in (0, 3):
                sys.exit("tool_accuracy: " + done.stderr.strip())
            rows = rows_of(Path(folder) / "increments.csv")
            self.ms = numbers(rows, "update_ms")
            self.not_ok = np.mean([row["status"] != "OK" for row in rows])
            self.status = worst(rows)
            nodes = rows_of(Path(folder) / "nodes.csv")
            if not nodes:    # flown apart
                return
            self.forces = np.array([[float(row[axis]) for axis in ("fx", "fy", "fz")]
                                    for row in rows_of(Path(folder) / "tools.csv")])
            self.shape = common_nodes(nodes)
        self.ok = True


def common_nodes(rows):
    places = np.array([[float(row[axis]) for axis in ("x", "y", "z")] for row in rows])
    moved = np.array([[float(row[axis]) for axis in ("ux", "uy", "uz")] for row in rows])
    grid = np.rint(places / COARSEST)
    common = np.abs(places - grid * COARSEST).max(axis=1) < 1e-6
    order = np.lexsort(grid[common].T)
    return moved[common][order]


def compared(row, done, right):
    """The row with how far a run that ended is off the fine one."""
    row["status"] = done.status
    if not done.ok:
        return row
    off = np.linalg.norm(done.forces - right.forces, axis=1)
    greatest = np.linalg.norm(right.forces, axis=1).max()
    shape_off = np.linalg.norm(done.shape - right.shape) / np.linalg.norm(right.shape)
    row.update({"not_ok_percent": f"{100.0 * done.not_ok:.3g}",
                "median_ms": f"{percentile(done.ms[1:], 50):.3g}",
                "mean_ms": f"{np.mean(done.ms[1:]):.3g}",
                "force_off_percent": f"{100.0 * np.sqrt((off ** 2).mean()) / greatest:.3g}",
                "shape_off_percent": f"{100.0 * shape_off:.3g}"})
    return row


def measure(options):
    simulate = program("simulate", options.programs)
    peer = simulate.parent / "bullet_tool"
    if not peer.exists():
        peer = None
        print("tool_accuracy: bullet_tool is not built; Bullet is left out", file=sys.stderr)
    jobs = [(tool, spacing, method, tolerance, None) for tool in TOOLS for spacing in SPACINGS
            for method, tolerances in METHODS.items() for tolerance in tolerances]
    if peer is not None:
        jobs += [(tool, spacing, method, None, steps) for tool in TOOLS for spacing in SPACINGS
                 for method, all_steps in BULLET.items() for steps in all_steps]
    if options.only is not None:
        jobs = [job for job in jobs if options.only in " ".join(map(str, job))]
    fine = {tool: Run([simulate], scene(tool, FINE[tool], "layered", 0.01), None)
            for tool in {job[0] for job in jobs}}
    if any(run.status != "OK" for run in fine.values()):
        sys.exit("tool_accuracy: the fine lattice finds no shape on all of the way")
    table = [] if options.only is None else rows_of(TABLE)
    for tool, spacing, method, tolerance, steps in progress(jobs, lambda job: " ".join(map(str, job))):
        row = {"tool": tool, "spacing_m": spacing, "method": method,
               "tolerance": "" if tolerance is None else tolerance, "steps": "" if steps is None else steps}
        if steps is None:
            done = Run([simulate], scene(tool, spacing, method, tolerance))
        else:
            how = ["--steps", str(steps), *(["--implicit"] if method == "bullet_implicit" else [])]
            done = Run([peer, *how], scene(tool, spacing, "layered", None), BULLETS_LIMIT)
        key = ("tool", "spacing_m", "method", "tolerance", "steps")
        table = [other for other in table if any(str(other[part]) != str(row[part]) for part in key)]
        table.append(compared(row, done, fine[tool]))
        write_rows(TABLE, ["tool", "spacing_m", "method", "tolerance", "steps", "status", "not_ok_percent",
                           "median_ms", "mean_ms", "force_off_percent", "shape_off_percent"], table)


# What did not end OK is in the table alone.
def draw():
    plt = pyplot()
    figure, axes = plt.subplots(2, 2, figsize=(10, 8), sharex=True)
    rows = [row for row in rows_of(TABLE) if row["status"] == "OK"]
    for line, tool in enumerate(TOOLS):
        for column, (key, name) in enumerate((("force_off_percent", "force"),
                                              ("shape_off_percent", "shape"))):
            plot = axes[line][column]
            for method, color in COLORS.items():
                for spacing, marker in zip(SPACINGS, "os^"):
                    own = [row for row in rows if row["tool"] == tool and row["method"] == method
                           and float(row["spacing_m"]) == spacing]
                    if not own:
                        continue
                    plot.plot(numbers(own, "mean_ms"), numbers(own, key), marker + "-", color=color,
                              label=f"{method}, {1e3 * spacing:g} mm", markersize=5)
            plot.set(xscale="log", yscale="log", ylabel=f"{name} off (%)", title=f"{tool}")
            plot.grid(True, which="both", alpha=0.3)
    for plot in axes[1]:
        plot.set_xlabel("ms an update of 0.5 mm (mean)")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=7, ncol=6, loc="upper center")
    figure.tight_layout(rect=(0, 0, 1, 0.94))
    figure.savefig(CHART, dpi=90)


def add_arguments(parser):
    parser.add_argument("--only", metavar="TEXT", help="runs whose name has this, in place of their rows: "
                        "tool, spacing in m, method, tolerance, steps")
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(options)
    draw()
    print_rows(rows_of(TABLE))
