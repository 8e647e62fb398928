"""Draws the liver of config/liver.yaml at rest, pressed, and cut and pulled open.

Each is a run of the scene up to that step; what is drawn is its surface.stl.
Out: doc/images/liver.png.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from studies.common import IMAGES, PACKAGE, add_programs, program, pyplot

PANELS = [("at rest", 0), ("pressed by 10 mm", 1), ("cut, one side pulled by 15 mm", 4)]  # steps
LIGHT = np.array([0.35, -0.55, 0.76])
COLOR = np.array([0.72, 0.30, 0.24])
ELEVATION, AZIMUTH = 38.0, -72.0  # degrees, of the viewer


def triangles_of(path):
    """Corners (m) of a binary STL's triangles, count x 3 x 3."""
    row = np.dtype([("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
    table = np.frombuffer(path.read_bytes()[84:], dtype=row)
    return table["corners"].reshape(-1, 3, 3).astype(float)


def surface_after(simulate, steps):
    path = PACKAGE / "config/liver.yaml"
    scene = yaml.safe_load(path.read_text())
    scene["tissue"]["shape"]["resource"] = str(PACKAGE / "config/meshes/liver.stl")
    scene["steps"] = scene["steps"][:steps]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(yaml.safe_dump(scene))
        done = subprocess.run([simulate, file, "--out", folder, "--quiet"], capture_output=True,
                              text=True)
        if done.returncode != 0:
            sys.exit("liver: " + done.stderr.strip())
        return triangles_of(Path(folder) / "surface.stl")


def draw(axes, triangles, title):
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1)
    bright = np.divide(normals @ (LIGHT / np.linalg.norm(LIGHT)), length,
                       out=np.zeros_like(length), where=length > 0)
    colors = np.clip(COLOR[None] * (0.35 + 0.75 * np.clip(bright, 0, 1))[:, None], 0, 1)
    axes.add_collection3d(Poly3DCollection(triangles, facecolors=colors, edgecolors=colors,
                                           linewidths=0.3))
    axes.set_xlim(-0.1, 0.1)
    axes.set_ylim(-0.075, 0.075)
    axes.set_zlim(-0.045, 0.045)
    axes.set_box_aspect((200, 150, 90), zoom=1.2)
    axes.set_proj_type("ortho")
    axes.view_init(ELEVATION, AZIMUTH)
    axes.set_axis_off()
    axes.set_title(title, fontsize=10, y=0.95)


def add_arguments(parser):
    add_programs(parser)


def run(options):
    simulate = program("simulate", options.programs)
    figure = pyplot().figure(figsize=(12, 3.2))
    for index, (title, steps) in enumerate(PANELS):
        axes = figure.add_subplot(1, len(PANELS), index + 1, projection="3d")
        draw(axes, surface_after(simulate, steps), title)
    figure.subplots_adjust(0, 0, 1, 0.96, 0, 0)
    figure.savefig(IMAGES / "liver.png", dpi=80)
