"""Draws when a grasper holds: its jaws' gap against close_gap and open_gap.

Runs the recipe "Grasp and pull" of doc/recipes.md up to each of its steps and cuts the surface through the jaws.
"""
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies.common import DATA, IMAGES, PACKAGE, add_plot, add_programs, numbers, program, pyplot, rows_of, write_rows

TABLE, CHART = DATA / "grasp.csv", IMAGES / "grasp.png"
COLUMNS = ["step", "y_mm", "z_mm", "to_y_mm", "to_z_mm"]
TITLES = ["open: the jaws come over the strip", "gap < close_gap: they hold", "they pull",
          "gap > open_gap: they let go"]
OPEN_AGAIN = {"move": {"tool": "forceps", "to": {"xyz": [0.03, 0.006, 0.043], "opening": 0.022}, "increments": 1}}


def recipe():
    """The scene, with jaws that open at its end where the recipe releases."""
    text = (PACKAGE / "doc/recipes.md").read_text()
    scene = yaml.safe_load(re.search(r"## Grasp and pull\n.*?```yaml\n(.*?)```", text, re.DOTALL).group(1))
    scene["steps"] = scene["steps"][:3] + [OPEN_AGAIN]
    return scene


def cut_across(triangles, x):
    """Where the plane cuts the triangles (n, 3, 3): pairs of (y, z)."""
    lines = []
    for corners in triangles:
        ends = []
        for one, other in ((0, 1), (1, 2), (2, 0)):
            a, b = corners[one], corners[other]
            if (a[0] < x) != (b[0] < x):
                ends.append((a + (x - a[0]) / (b[0] - a[0]) * (b - a))[1:])
        if len(ends) == 2:
            lines.append(ends)
    return lines


def triangles_of(path):
    """Of a binary STL file."""
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return np.frombuffer(path.read_bytes()[84:], dtype=facet)["corners"].astype(float)


def measure(simulate):
    scene, rows = recipe(), []
    with tempfile.TemporaryDirectory() as folder:
        for step in range(len(scene["steps"])):
            file, out = Path(folder) / "scene.yaml", Path(folder) / str(step)
            file.write_text(yaml.safe_dump({**scene, "steps": scene["steps"][:step + 1]}))
            subprocess.run([simulate, file, "--out", out], check=True, stdout=subprocess.DEVNULL)
            x = scene["steps"][step]["move"]["to"]["xyz"][0]
            for (y, z), (to_y, to_z) in cut_across(triangles_of(out / "surface.stl"), x):
                rows.append({"step": step, **{name: f"{1e3 * value:.4f}" for name, value in
                                              zip(COLUMNS[1:], (y, z, to_y, to_z))}})
    write_rows(TABLE, COLUMNS, rows)


def draw_gap(plot, below, size, text):
    plot.annotate("", (-0.5 * size, below), (0.5 * size, below), arrowprops={"arrowstyle": "<->", "color": "black"})
    plot.text(0.0, below - 0.6, text, ha="center", va="top", fontsize=8,
              bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})


def draw():
    scene, rows, plt = recipe(), rows_of(TABLE), pyplot()
    tool = scene["tools"][0]
    across, high = (1e3 * tool["jaws"][0]["shapes"][0]["size"][axis] for axis in (1, 2))
    close = 1e3 * tool["grasp"]["close_gap"]
    figure, plots = plt.subplots(1, len(TITLES), figsize=(11, 3.4), sharey=True)
    for step, (plot, title) in enumerate(zip(plots, TITLES)):
        to = scene["steps"][step]["move"]["to"]
        middle, gap = 1e3 * to["xyz"][2], 1e3 * to["opening"] - across
        for row in (row for row in rows if int(row["step"]) == step):
            y, z, to_y, to_z = (numbers([row], name)[0] for name in COLUMNS[1:])
            plot.plot([y - 1e3 * to["xyz"][1], to_y - 1e3 * to["xyz"][1]], [z, to_z], color="#b5485d", lw=1.2)
        for side in (-1, 1):
            left = side * 0.5 * gap - (across if side < 0 else 0)
            plot.add_patch(plt.Rectangle((left, middle - 0.5 * high), across, high, color="#7a8a99"))
        draw_gap(plot, middle + 0.5 * high + 2.5, gap, "")
        plot.text(0.0, middle + 0.5 * high + 3.8, f"gap {gap:.0f} mm", ha="center", fontsize=8)
        draw_gap(plot, 29.0, close, f"close_gap {close:.0f} mm")
        draw_gap(plot, 25.5, 1.5 * close, f"open_gap {1.5 * close:.0f} mm")
        plot.set(title=title, aspect="equal", xlim=(-15, 15), ylim=(22, 56), xlabel="mm")
        plot.title.set_fontsize(9)
    figure.tight_layout()
    figure.savefig(CHART, dpi=110)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(program("simulate", options.programs))
    draw()
