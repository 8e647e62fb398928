"""Measures model against finite elements: force and displacement of test/data/reference.

Every case is a scene that the offline runner solves. Writes doc/data/accuracy.csv, a row a case and
run, and draws doc/images/accuracy.png from it. --plot draws only. Rows that the file has already
are kept unless --again is given. --placements writes doc/data/placements.csv instead: press_d1 with
the patch at random places (fixed seed), its edges between nodes.
"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies.common import (DATA, IMAGES, PACKAGE, add_plot, add_programs, program, progress,
                            pyplot, rows_of, worst, write_rows)

REFERENCE = PACKAGE / "test/data/reference"
TABLE = DATA / "accuracy.csv"
PLACEMENTS = DATA / "placements.csv"
PLOT = IMAGES / "accuracy.png"

EXTENT = (0.10, 0.10, 0.05)  # m
REFERENCE_SPACING = 0.005    # m
REFERENCE_UNIT = 1e-8        # m
# model, method, tolerance, spacings (m)
RUNS = [("elastic", "newton", None, (0.01, 0.005, 0.0025)),
        ("elastic", "layered", 1e-2, (0.01, 0.005, 0.0025)),
        ("elastic", "layered", 1e-3, (0.01, 0.005, 0.0025)),
        ("six_spring", "paper", None, (0.01, 0.005, 0.0025))]
COLUMNS = ["case", "poisson_ratio", "model", "method", "tolerance", "spacing_m", "status",
           "increments", "iterations", "wall_ms", "force_n", "reference_n", "force_error_percent",
           "field_error_percent", "error_estimate", "volume_ratio"]
KEY = COLUMNS[:6]


def patch_box(case):
    whole = case in ("uniaxial", "shear")
    low, high = (0.0, 0.10) if whole else (0.04, 0.06)
    return [low, low, EXTENT[2]], [high, high, EXTENT[2]]


def displacement_of(reference):
    return [reference[key] if reference[key] == "free" else float(reference[key])
            for key in ("ux", "uy", "uz")]


def scene_of(reference, model, method, spacing, shift=(0.0, 0.0)):
    low, high = patch_box(reference["case"])
    low, high = ([edge[0] + shift[0], edge[1] + shift[1], edge[2]] for edge in (low, high))
    material = {"young_modulus": 1e4}
    if model != "six_spring":
        material["poisson_ratio"] = float(reference["poisson_ratio"])
    return {
        "tissue": {
            "shape": {"type": "box", "min": [0.0, 0.0, 0.0], "max": list(EXTENT)},
            "spacing": spacing, "model": model, "material": material,
            "fixed": [{"min": [-1.0, -1.0, -1e-6], "max": [1.0, 1.0, 1e-6]}]},
        "solver": {"method": method},
        "steps": [{"load": {"patches": [{"name": "punch", "min": low, "max": high,
                                         "displacement": displacement_of(reference)}]}}]}


def reference_field(reference):
    name = f"{reference['case']}_nu{reference['poisson_ratio'][2:]}.csv"
    return REFERENCE_UNIT * np.loadtxt(REFERENCE / name, delimiter=",", skiprows=1)


def reference_nodes():
    counts = [round(extent / REFERENCE_SPACING) + 1 for extent in EXTENT]
    k, j, i = np.meshgrid(*(np.arange(count) for count in reversed(counts)), indexing="ij")
    return REFERENCE_SPACING * np.stack([i, j, k], axis=-1).reshape(-1, 3)


def field_error(reference, table, spacing):
    """Relative L2 over the reference's nodes that are nodes of the lattice, too."""
    counts = [round(extent / spacing) + 1 for extent in EXTENT]
    moved = table[:, 3:].reshape(counts[2], counts[1], counts[0], 3)
    place = reference_nodes() / spacing
    index = np.rint(place).astype(int)
    common = np.all(np.abs(place - index) < 1e-6, axis=1)
    i, j, k = index[common].T
    expected = reference_field(reference)[common]
    return np.linalg.norm(moved[k, j, i] - expected) / np.linalg.norm(expected)


def solve(simulate, scene, tolerance, folder):
    """Rows of increments.csv and the norm of the patch's last force (N)."""
    scene_file = folder / "scene.yaml"
    scene_file.write_text(yaml.safe_dump(scene))
    command = [str(simulate), str(scene_file), "--out", str(folder), "--quiet"]
    if tolerance is not None:
        command += ["--tolerance", str(tolerance)]
    done = subprocess.run(command, stderr=subprocess.PIPE, universal_newlines=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit("accuracy: " + done.stderr.strip())
    patch = rows_of(folder / "patches.csv")[-1]
    force = math.hypot(*(float(patch[key]) for key in ("fx", "fy", "fz")))
    return rows_of(folder / "increments.csv"), force


def solve_case(simulate, reference, model, method, tolerance, spacing, folder):
    scene = scene_of(reference, model, method, spacing)
    increments, force = solve(simulate, scene, tolerance, folder)
    expected = float(reference["force_n"])
    field = field_error(reference, np.loadtxt(folder / "nodes.csv", delimiter=",", skiprows=1),
                        spacing)
    return {
        "status": worst(increments),
        "increments": len(increments),
        "iterations": sum(int(row["iterations"]) for row in increments),
        "wall_ms": f"{sum(float(row['wall_ms']) for row in increments):.1f}",
        "force_n": f"{force:.6g}", "reference_n": reference["force_n"],
        "force_error_percent": f"{100.0 * (force / expected - 1.0):.3f}",
        "field_error_percent": f"{100.0 * field:.3f}",
        "error_estimate": f"{float(increments[-1]['error_estimate']):.2e}",
        "volume_ratio": f"{float(increments[-1]['volume_ratio']):.5f}"}


def measure_placements(simulate):
    """The reference's patch is in the middle: moved by up to a spacing it meets the same force, but
    for what the block's sides change; the rows at 2.5 mm, edges on nodes, tell how much that is."""
    shifts = [(0.005, shift) for shift in
              np.random.default_rng(1).uniform(-0.005, 0.005, (20, 2)).round(6).tolist()]
    shifts += [(0.0025, (x, y)) for x, y in ((0.0, 0.0), (0.005, 0.0), (0.005, 0.005))]
    with open(PLACEMENTS, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["poisson_ratio", "spacing_m", "shift_x_m", "shift_y_m", "status", "force_n",
                        "reference_n", "force_error_percent"])
        for reference in rows_of(REFERENCE / "cases.csv"):
            if reference["case"] != "press_d1":
                continue
            for spacing, shift in shifts:
                scene = scene_of(reference, "elastic", "layered", spacing, shift)
                with tempfile.TemporaryDirectory() as folder:
                    increments, force = solve(simulate, scene, 1e-3, Path(folder))
                error = 100.0 * (force / float(reference["force_n"]) - 1.0)
                row = [reference["poisson_ratio"], spacing, *shift, worst(increments),
                       f"{force:.6g}", reference["force_n"], f"{error:.3f}"]
                table.writerow(row)
                print(*row, flush=True)


def key_of(row):
    return tuple(str(row[column]) for column in KEY)


def jobs():
    """A reference, how it is solved, and the row that it becomes."""
    for model, method, tolerance, spacings in RUNS:
        for spacing in spacings:
            for reference in rows_of(REFERENCE / "cases.csv"):
                if model == "six_spring" and reference["poisson_ratio"] != "0.25":
                    continue  # it has no Poisson's ratio
                row = {"case": reference["case"], "poisson_ratio": reference["poisson_ratio"],
                       "model": model, "method": method, "tolerance": tolerance or "",
                       "spacing_m": spacing}
                yield reference, (model, method, tolerance, spacing), row


def measure(simulate, only, again):
    done = {key_of(row): row for row in rows_of(TABLE)}
    todo = [job for job in jobs() if (again or key_of(job[2]) not in done)
            and (not only or only in "/".join(key_of(job[2])))]
    for reference, how, row in progress(todo, lambda job: "/".join(key_of(job[2]))):
        with tempfile.TemporaryDirectory() as folder:
            row.update(solve_case(simulate, reference, *how, Path(folder)))
        done[key_of(row)] = row
        print(*key_of(row), row["status"], row["wall_ms"], "ms, force",
              row["force_error_percent"], "%, field", row["field_error_percent"], "%", flush=True)
        write_rows(TABLE, COLUMNS, (done[key] for key in sorted(done)))


def draw():
    plt = pyplot()
    rows = rows_of(TABLE)
    references = rows_of(REFERENCE / "cases.csv")
    cases = list(dict.fromkeys(row["case"] for row in references))
    plate, all_axes = plt.subplots(2, len(cases), figsize=(3.0 * len(cases), 6.2), sharex=True,
                                   sharey="row")
    lines = [("elastic", "newton", "0.25", "tab:blue", "o"),
             ("elastic", "newton", "0.45", "tab:red", "o"),
             ("elastic", "layered", "0.25", "tab:blue", "x"),
             ("elastic", "layered", "0.45", "tab:red", "x"),
             ("six_spring", "paper", "0.25", "0.5", "s")]
    for column, case in enumerate(cases):
        for row, key, title in ((0, "force_error_percent", "force error (%)"),
                                (1, "field_error_percent", "displacement error (%)")):
            axes = all_axes[row][column]
            for model, method, ratio, color, marker in lines:
                points = sorted((float(line["spacing_m"]) * 1e3, abs(float(line[key])))
                                for line in rows
                                if (line["case"], line["model"], line["method"],
                                    line["poisson_ratio"]) == (case, model, method, ratio)
                                and line["tolerance"] != "0.01")
                label = f"{model}, {method}" + (f", {ratio}" if model == "elastic" else "")
                if points:
                    axes.loglog(*zip(*points), color=color, marker=marker, label=label,
                                linestyle="-" if method != "layered" else ":",
                                markersize=7 if marker == "x" else 4)
            for reference in references:
                if reference["case"] == case:
                    bound = reference["error_percent" if row == 0 else "field_change_percent"]
                    color = "tab:blue" if reference["poisson_ratio"] == "0.25" else "tab:red"
                    axes.axhline(float(bound), color=color, linewidth=0.8, linestyle="--")
            axes.set_xticks([2.5, 5.0, 10.0])
            axes.set_xticklabels(["2.5", "5", "10"])
            axes.minorticks_off()
            axes.grid(True, which="major", linewidth=0.3)
            axes.set_ylim(0.01, 200.0)
            if row == 0:
                axes.set_title(case)
            else:
                axes.set_xlabel("lattice spacing (mm)")
            if column == 0:
                axes.set_ylabel(title)
    handles, labels = all_axes[0][0].get_legend_handles_labels()
    plate.legend(handles, labels, loc="lower center", ncol=len(labels), frameon=False)
    plate.tight_layout(rect=(0.0, 0.05, 1.0, 1.0))
    PLOT.parent.mkdir(parents=True, exist_ok=True)
    plate.savefig(PLOT, dpi=110)


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--only", help="only runs whose key, joined by /, holds this text")
    parser.add_argument("--again", action="store_true", help="also runs that are in the table")
    parser.add_argument("--placements", action="store_true", help="patches at random places")
    add_plot(parser)


def run(options):
    if options.placements:
        measure_placements(program("simulate", options.programs))
        return
    if not options.plot:
        measure(program("simulate", options.programs), options.only, options.again)
    draw()
