"""Draws figures 5 and 6 of the paper from config/paper_figure5.yaml and paper_figure6.yaml.

Every load of a scene is run by itself (a scene with that load alone), several times for the time.
Out: doc/images/paper_figure5.png, doc/images/paper_figure6.png and doc/data/paper_figures.csv.
"""

import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml
from matplotlib.collections import LineCollection

from studies.common import (DATA, IMAGES, PACKAGE, add_programs, commit, compiler_of, first_match,
                            program, progress, pyplot, rows_of, worst, write_rows)

TITLES = {5: "straight downward force", 6: "diagonal upward force, along (1, 1, 1)"}
AZIMUTH = math.radians(18.0)    # of the viewer, from the block's front (y = 0)
ELEVATION = math.radians(12.0)
MM = 1e3
CM3 = 1e6

COLUMNS = ["figure", "magnitude_n", "time_ms_median", "time_ms_min", "time_ms_max", "runs",
           "increments", "status", "greatest_mm", "patch_x_mm", "patch_y_mm", "patch_z_mm",
           "volume_ratio", "volume_lost_cm3", "dent_cm3", "bottom_bulge_mm", "side_bulge_mm",
           "top_rise_mm", "layers", "sweeps", "answer_n"]


class Shape:
    """Rest positions and displacements (m) of the nodes, as arrays over (k, j, i)."""

    def __init__(self, path):
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        size = [len(np.unique(np.round(table[:, axis], 9))) for axis in (2, 1, 0)]
        self.rest = table[:, :3].reshape(size + [3])
        self.moved = table[:, 3:].reshape(size + [3])
        self.spacing = self.rest[0, 0, 1, 0] - self.rest[0, 0, 0, 0]

    def extent(self):
        return self.rest[-1, -1, -1] - self.rest[0, 0, 0]

    def greatest(self):
        return np.linalg.norm(self.moved, axis=3).max()

    def bottom_bulge(self):
        return max(0.0, -self.moved[0, :, :, 2].min())

    def top_rise(self):
        return max(0.0, self.moved[-1, :, :, 2].max())

    def side_bulge(self):
        return max(0.0, self.moved[:, :, -1, 0].max(), -self.moved[:, :, 0, 0].min(),
                   self.moved[:, -1, :, 1].max(), -self.moved[:, 0, :, 1].min())

    def dent(self):
        """Volume (m^3) that the top face swept downwards, over its rest area."""
        weight = np.ones(self.moved.shape[1:3])
        weight[[0, -1], :] *= 0.5
        weight[:, [0, -1]] *= 0.5
        return float((weight * np.maximum(0.0, -self.moved[-1, :, :, 2])).sum()) * self.spacing**2


def single_load_scenes(scene):
    for step in scene["steps"]:
        if "load" in step:
            force = np.array(step["load"]["patches"][0]["force"], dtype=float)
            yield float(np.linalg.norm(force)), dict(scene, steps=[step])


def solve(simulate, scene, folder):
    scene_file = folder / "scene.yaml"
    scene_file.write_text(yaml.safe_dump(scene))
    command = [str(simulate), str(scene_file), "--out", str(folder), "--quiet"]
    done = subprocess.run(command, stderr=subprocess.PIPE, universal_newlines=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit("paper: " + done.stderr.strip())
    return rows_of(folder / "increments.csv"), rows_of(folder / "patches.csv")[-1]


def measure(simulate, figure, magnitude, scene, runs, folder):
    """One row of the table, and the shape."""
    times = []
    for number in range(1, runs + 1):
        increments, patch = solve(simulate, scene, folder)
        times.append(sum(float(row["wall_ms"]) for row in increments))
        print(f"figure {figure}, magnitude {magnitude:g}, run {number} of {runs}: "
              f"{times[-1]:.2f} ms, {worst(increments)}", flush=True)
    shape = Shape(folder / "nodes.csv")
    ratio = float(increments[-1]["volume_ratio"])
    row = {
        "figure": figure, "magnitude_n": f"{magnitude:g}",
        "time_ms_median": f"{statistics.median(times):.3f}",
        "time_ms_min": f"{min(times):.3f}", "time_ms_max": f"{max(times):.3f}",
        "runs": runs, "increments": len(increments), "status": worst(increments),
        "greatest_mm": f"{shape.greatest() * MM:.4f}",
        "volume_ratio": f"{ratio:.6f}",
        "volume_lost_cm3": f"{(1.0 - ratio) * np.prod(shape.extent()) * CM3:.4f}",
        "dent_cm3": f"{shape.dent() * CM3:.4f}",
        "bottom_bulge_mm": f"{shape.bottom_bulge() * MM:.4f}",
        "side_bulge_mm": f"{shape.side_bulge() * MM:.4f}",
        "top_rise_mm": f"{shape.top_rise() * MM:.4f}",
        "layers": max(int(line["layers"]) for line in increments),
        "sweeps": sum(int(line["iterations"]) for line in increments),
        "answer_n": f"{math.hypot(*(float(patch[key]) for key in ('fx', 'fy', 'fz'))):.6f}"}
    for axis in "xyz":
        row[f"patch_{axis}_mm"] = f"{float(patch['u' + axis]) * MM:.4f}"
    return row, shape


def project(points):
    """Parallel projection on the picture's plane: right, up."""
    right = np.array([math.cos(AZIMUTH), math.sin(AZIMUTH), 0.0])
    up = np.array([-math.sin(ELEVATION) * math.sin(AZIMUTH),
                   math.sin(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION)])
    return np.stack([points @ right, points @ up], axis=-1)


def springs_on(points, face):
    """Segments along the two directions of one face, e.g. face = np.s_[-1, :, :] for the top."""
    sheet = points[face]
    along = np.stack([sheet[:, :-1], sheet[:, 1:]], axis=-2).reshape(-1, 2, 2)
    across = np.stack([sheet[:-1], sheet[1:]], axis=-2).reshape(-1, 2, 2)
    return np.concatenate([along, across])


def patch_nodes(shape, box):
    slack = 1e-3 * shape.spacing
    low, high = np.array(box["min"]) - slack, np.array(box["max"]) + slack
    inside = (shape.rest >= low) & (shape.rest <= high)
    j, i = np.nonzero(inside.all(axis=3)[-1])
    return np.s_[-1, j.min():j.max() + 1, i.min():i.max() + 1]


def draw_shape(axes, shape, box):
    points = project((shape.rest + shape.moved) * MM)
    middle = points.shape[1] // 2
    layers = [  # faces, color, width: from the back to the front
        ([np.s_[:, -1, :], np.s_[:, :, 0], np.s_[0, :, :]], "0.80", 0.4),
        ([np.s_[:, 0, :], np.s_[:, :, -1], np.s_[-1, :, :]], "0.35", 0.5),
        ([np.s_[:, middle, :]], "tab:blue", 1.1),
        ([patch_nodes(shape, box)], "tab:red", 1.6)]
    for faces, color, width in layers:
        for face in faces:
            axes.add_collection(LineCollection(springs_on(points, face), colors=color,
                                               linewidths=width, capstyle="round"))
    return points.reshape(-1, 2)


def draw(figure, results, path):
    plt = pyplot()
    plate, all_axes = plt.subplots(2, 3, figsize=(13.5, 7.2))
    corners = []
    for letter, axes, (row, shape, box) in zip("abcdef", all_axes.flat, results):
        corners.append(draw_shape(axes, shape, box))
        status = "" if row["status"] == "OK" else f", {row['status']}"
        axes.set_title(f"({letter}) magnitude {row['magnitude_n']} N, "
                       f"time {float(row['time_ms_median']):.1f} ms{status}\n"
                       f"greatest displacement {float(row['greatest_mm']):.1f} mm, "
                       f"volume ratio {float(row['volume_ratio']):.4f}", y=-0.2, fontsize=10)
    corners = np.concatenate(corners)
    low, high = corners.min(axis=0) - 2.0, corners.max(axis=0) + 2.0
    for axes in all_axes.flat:
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        axes.axis("off")
    plate.suptitle(f"Figure {figure} of the paper, repeated: {TITLES[figure]}\n"
                   "red: loading area; blue: section through the middle of the block",
                   fontsize=11)
    plate.subplots_adjust(left=0.01, right=0.99, top=0.91, bottom=0.10, wspace=0.03, hspace=0.22)
    path.parent.mkdir(parents=True, exist_ok=True)
    plate.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(plate)


def header(simulate):
    processor = first_match(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text())
    return (f"# processor: {processor}, one thread\n# compiler: {compiler_of(simulate)}\n"
            f"# last commit before the run: {commit()}\n"
            "# times: sum over the increments of the solve alone; shapes: full precision in the "
            "runner's nodes.csv\n")


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--runs", type=int, default=15, metavar="N", help="of each load (15)")


def run(options):
    if options.runs < 1:
        sys.exit(f"paper: --runs {options.runs}: must be at least 1")
    simulate = program("simulate", options.programs)
    rows = []
    for figure in progress((5, 6), lambda figure: f"figure {figure}"):
        scene = yaml.safe_load((PACKAGE / f"config/paper_figure{figure}.yaml").read_text())
        results = []
        for magnitude, single in single_load_scenes(scene):
            with tempfile.TemporaryDirectory() as folder:
                row, shape = measure(simulate, figure, magnitude, single, options.runs,
                                     Path(folder))
            results.append((row, shape, single["steps"][0]["load"]["patches"][0]))
            rows.append(row)
        draw(figure, results, IMAGES / f"paper_figure{figure}.png")
    write_rows(DATA / "paper_figures.csv", COLUMNS, rows, header(simulate))
    print("wrote doc/images/paper_figure5.png, doc/images/paper_figure6.png, "
          "doc/data/paper_figures.csv")
