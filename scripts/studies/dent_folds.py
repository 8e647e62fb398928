"""How sharply the drawn surface folds at the rim of a dent that a tool drags along.

Presses a tool into a block of 100 x 100 x 50 mm at 5 mm, drags it, and looks at the surface that
`simulate` writes: the greatest angle between the outward normals of two neighboring triangles, and
how many edges have more than 90 and 120 degrees, away from the block's own edges. Flat skin has 0,
a triangle that lies folded back on its neighbor 180. Writes doc/data/dent_folds.csv with the
commit; doc/contact_measured.md quotes it.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from studies.common import DATA, add_programs, commit, program, progress, rows_of, worst, write_rows

TABLE = DATA / "dent_folds.csv"
COLUMNS = ["tool", "friction", "status", "greatest_deg", "over_90", "over_120", "commit"]
# Name, shape, and how far its lowest point is below its origin (m).
TOOLS = [("box of 20 mm", "type: box, size: [0.02, 0.02, 0.02]", 0.01),
         ("box of 8 mm", "type: box, size: [0.008, 0.008, 0.02]", 0.01),
         ("upright cylinder, radius 10 mm", "type: cylinder, radius: 0.01, length: 0.02", 0.01),
         ("upright cylinder, radius 4 mm", "type: cylinder, radius: 0.004, length: 0.02", 0.01),
         ("sphere, radius 6 mm", "type: sphere, radius: 0.006", 0.006)]
DEPTH, DRAG = 0.009, 0.02  # m
SIDES, TOP = 0.008, 0.02  # m: edges so near the block's sides, or lower, are not looked at
SCENE = """tissue:
  shape: {{type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}}
  spacing: 0.005
  material: {{young_modulus: 10000, poisson_ratio: 0.45, density: 1000}}
  fixed: [{{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}}]
tools:
  - {{name: probe, friction: {friction}, shapes: [{{{shape}}}]}}
steps:
  - move: {{tool: probe, from: {{xyz: [0.04, 0.05, {out}]}}, to: {{xyz: [0.04, 0.05, {deep}]}}, increments: 5}}
  - move: {{tool: probe, from: {{xyz: [0.04, 0.05, {deep}]}}, to: {{xyz: [{end}, 0.05, {deep}]}}, increments: 5}}
"""
STL = np.dtype([("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
HEAD = 84  # bytes


def angles_of(path):
    """Degrees, at edges of two triangles in the middle of the block's top."""
    corners = np.frombuffer(path.read_bytes()[HEAD:], STL)["corners"].reshape(-1, 3, 3).astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    at_edge = {}
    for triangle, places in enumerate(corners):
        for corner in range(3):
            ends = frozenset((tuple(places[corner]), tuple(places[(corner + 1) % 3])))
            at_edge.setdefault(ends, []).append(triangle)
    angles = []
    for ends, triangles in at_edge.items():
        x, y, z = np.mean(list(ends), axis=0)
        inside = min(x, y) > SIDES and max(x, y) < 0.1 - SIDES and z > TOP
        if inside and len(triangles) == 2:
            cosine = np.clip(normals[triangles[0]] @ normals[triangles[1]], -1.0, 1.0)
            angles.append(np.degrees(np.arccos(cosine)))
    return np.array(angles)


def measure(simulate, tool, friction, folder):
    name, shape, below = tool
    deep = 0.05 + below - DEPTH
    scene = folder / "scene.yaml"
    scene.write_text(SCENE.format(shape=shape, friction=friction, out=0.052 + below, deep=deep, end=0.04 + DRAG))
    # Exit code 3: some increment is not OK; the table says so.
    subprocess.run([str(simulate), str(scene), "--out", str(folder / "out"), "--quiet"], check=False)
    angles = angles_of(folder / "out/surface.stl")
    return {"tool": name, "friction": friction, "status": worst(rows_of(folder / "out/increments.csv")),
            "greatest_deg": f"{angles.max():.0f}", "over_90": int((angles > 90.0).sum()),
            "over_120": int((angles > 120.0).sum()), "commit": commit()}


def add_arguments(parser):
    add_programs(parser)


def run(options):
    simulate = program("simulate", options.programs)
    rows = []
    for tool, friction in progress([(tool, friction) for tool in TOOLS for friction in (0.3, 0.8)], str):
        with tempfile.TemporaryDirectory() as folder:
            rows.append(measure(simulate, tool, friction, Path(folder)))
    write_rows(TABLE, COLUMNS, rows)
    print("| tool | friction | status | greatest angle | over 90, 120 degrees |\n|---|---|---|---|---|")
    for row in rows:
        print("| {tool} | {friction} | {status} | {greatest_deg} | {over_90}, {over_120} |".format(**row))
