"""Holds the errors that `fidelity` estimates against those that finite elements tell.

For cases of test/data/reference, as scenes with a spacing of 5 mm: runs `fidelity`, solves each of
its rungs again with `simulate`, and measures how far that is from the reference at the same points.
Writes doc/data/fidelity.csv and prints estimate and truth side by side, and for some errors whether
the rung that `fidelity` would take is the cheapest that truly meets them.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies import accuracy
from studies.common import DATA, add_programs, program, progress, rows_of, write_rows

TABLE = DATA / "fidelity.csv"
SCENES = ["press_d5/0.45", "drag_d5/0.25", "uniaxial/0.45"]
UPDATE = 0.001  # m
ERRORS = (0.15, 0.10, 0.05, 0.03)  # that a choice is asked for
COLUMNS = ["case", "poisson_ratio", "spacing_m", "tolerance", "estimate", "truth", "ratio",
           "field_estimate", "field_truth", "force_estimate", "force_truth", "ms_per_update"]


def updates_of(reference):
    way = [0.0 if value == "free" else value for value in accuracy.displacement_of(reference)]
    return math.ceil(math.hypot(*way) / UPDATE - 1e-9)


def scene_of(reference, spacing, parts=1):
    scene = accuracy.scene_of(reference, "elastic", "layered", spacing)
    scene["steps"][0]["load"]["increments"] = parts * updates_of(reference)
    return scene


def between_nodes(moved, spacing, points):
    """Trilinear in a table over (k, j, i) of displacements."""
    place = points / spacing
    last_cell = np.array(moved.shape[2::-1]) - 2
    lowest = np.minimum(np.floor(place + 1e-9).astype(int), last_cell)
    inner = place - lowest
    result = np.zeros_like(points)
    for corner in range(8):
        upper = np.array([corner & 1, corner >> 1 & 1, corner >> 2 & 1])
        weight = np.prod(np.where(upper, inner, 1.0 - inner), axis=1)
        i, j, k = (lowest + upper).T
        result += weight[:, None] * moved[k, j, i]
    return result


def truth_of(simulate, reference, spacing, tolerance):
    """Relative error of displacements and of the force."""
    parts = max(1, math.ceil(UPDATE / (0.5 * spacing) - 1e-9))
    with tempfile.TemporaryDirectory() as folder:
        _, force = accuracy.solve(simulate, scene_of(reference, spacing, parts), tolerance,
                                  Path(folder))
        table = np.loadtxt(Path(folder) / "nodes.csv", delimiter=",", skiprows=1)
    counts = [round(extent / spacing) + 1 for extent in accuracy.EXTENT]
    moved = table[:, 3:].reshape(counts[2], counts[1], counts[0], 3)
    found = between_nodes(moved, spacing, accuracy.reference_nodes())
    expected = accuracy.reference_field(reference)
    field = np.linalg.norm(found - expected) / np.linalg.norm(expected)
    return field, abs(force / float(reference["force_n"]) - 1.0)


def estimates_of(fidelity, reference, seconds):
    with tempfile.TemporaryDirectory() as folder:
        scene, table = Path(folder) / "scene.yaml", Path(folder) / "table.csv"
        scene.write_text(yaml.safe_dump(scene_of(reference, accuracy.REFERENCE_SPACING)))
        command = [str(fidelity), str(scene), "--error", "0.5", "--rate", "0.001", "--seconds",
                   str(seconds), "--csv", str(table)]
        done = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True, check=False)
        if done.returncode not in (0, 3):
            sys.exit("fidelity: it gave exit code " + str(done.returncode))
        return [row for row in rows_of(table) if row["status"] == "OK" and row["error"]]


def measure(programs, reference, seconds):
    simulate = program("simulate", programs)
    for estimate in estimates_of(program("fidelity", programs), reference, seconds):
        field, force = truth_of(simulate, reference, float(estimate["spacing"]),
                                float(estimate["tolerance"]))
        truth = max(field, force)
        yield {"case": reference["case"], "poisson_ratio": reference["poisson_ratio"],
               "spacing_m": estimate["spacing"], "tolerance": estimate["tolerance"],
               "estimate": f"{float(estimate['error']):.4g}", "truth": f"{truth:.4g}",
               "ratio": f"{float(estimate['error']) / truth:.2f}",
               "field_estimate": f"{float(estimate['field_error']):.4g}",
               "field_truth": f"{field:.4g}",
               "force_estimate": f"{float(estimate['force_error']):.4g}",
               "force_truth": f"{force:.4g}",
               "ms_per_update": f"{float(estimate['median_ms']):.3g}"}


def cheapest(rows, key, error):
    meeting = [row for row in rows if float(row[key]) <= error]
    return min(meeting, key=lambda row: float(row["ms_per_update"]), default=None)


def name_of(row):
    return f"{1e3 * float(row['spacing_m']):.4g} mm at {row['tolerance']}" if row else "none"


def tell(rows, reference):
    print(f"\n{reference['case']}, nu {reference['poisson_ratio']} (the reference's own error: "
          f"force {reference['error_percent']} %, displacements {reference['field_change_percent']}"
          " %)\n")
    print("| spacing, tolerance | estimate | truth | estimate / truth | ms an update |\n"
          "|---|---|---|---|---|")
    for row in rows:
        print(f"| {name_of(row)} | {1e2 * float(row['estimate']):.3g} % | "
              f"{1e2 * float(row['truth']):.3g} % | {row['ratio']} | {row['ms_per_update']} |")
    for error in ERRORS:
        taken = cheapest(rows, "estimate", error)
        best = cheapest(rows, "truth", error)
        met = "" if taken is None or float(taken["truth"]) <= error else ", which misses it"
        print(f"within {1e2 * error:g} %: taken {name_of(taken)}{met}; by the truth "
              f"{name_of(best)}")


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--case", action="append", metavar="CASE/NU",
                        help="e.g. press_d1/0.25; default: " + ", ".join(SCENES))
    parser.add_argument("--seconds", type=float, default=60.0, help="for each fidelity run (60)")


def run(options):
    wanted = options.case or SCENES
    chosen = [row for row in rows_of(accuracy.REFERENCE / "cases.csv")
              if f"{row['case']}/{row['poisson_ratio']}" in wanted]
    if not chosen:
        sys.exit("fidelity: no case of this name: " + ", ".join(wanted))
    all_rows = []
    for reference in progress(chosen, lambda row: row["case"]):
        rows = list(measure(options.programs, reference, options.seconds))
        tell(rows, reference)
        all_rows += rows
    write_rows(TABLE, COLUMNS, all_rows)
