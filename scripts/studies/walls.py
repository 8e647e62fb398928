"""Measures walls that are thin against the spacing, and organs wherever they stand in the grid.

A hollow dome under a sphere, at spacings of more than its wall and of a third of it; a block by a mesh, liver and
kidney under a sphere at random places of the grid. What moves the grid is a small box far off, which is fixed.
Out: doc/data/walls.csv. With --plot the table is only printed. What strips do is in `thin_walls`.
"""

import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

from studies.common import DATA, PACKAGE, add_plot, add_programs, program, rows_of, write_rows, worst

TABLE = DATA / "walls.csv"
COLUMNS = ["case", "spacing", "place", "force", "cycles", "cycles_most", "status"]
FAR = 0.15  # m, of the box beside the shape's own
PLACES = 10
DOME_SPACINGS = [0.005, 0.004, 0.003, 0.001]  # the last one tells what is true


def ring_shell(outer, wall, below, rings, around):
    """A half sphere of this wall, with a tube below, as closed rings: outer side down, inner side up."""
    profile = []
    for i in range(rings + 1):
        angle = 0.5 * math.pi * i / rings
        profile.append((outer * math.sin(angle), outer * math.cos(angle)))
    profile.append((outer, -below))
    inner = outer - wall
    profile.append((inner, -below))
    for i in range(rings, -1, -1):
        angle = 0.5 * math.pi * i / rings
        profile.append((inner * math.sin(angle), inner * math.cos(angle)))

    def point(place, turn):
        angle = 2.0 * math.pi * (turn % around) / around
        radius, z = profile[place]
        if radius < 1e-12:
            return (0.0, 0.0, z)
        return (radius * math.cos(angle), radius * math.sin(angle), z)

    triangles = []
    for place in range(len(profile) - 1):
        for turn in range(around):
            a, b = point(place, turn), point(place, turn + 1)
            c, d = point(place + 1, turn), point(place + 1, turn + 1)
            triangles += [t for t in ((a, c, d), (a, d, b)) if len(set(t)) == 3]
    return triangles


def box(low, high):
    corner = [tuple((high if i >> axis & 1 else low)[axis] for axis in range(3)) for i in range(8)]
    faces = [(0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3),
             (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6)]
    return [tuple(corner[i] for i in face) for face in faces]


def stl_of(path):
    """Triangles of a binary STL of millimeters (m)."""
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    triangles = []
    for i in range(count):
        values = struct.unpack_from("<9f", data, 84 + 50 * i + 12)
        triangles.append(tuple(tuple(1e-3 * v for v in values[3 * k:3 * k + 3]) for k in range(3)))
    return triangles


def write_stl(path, triangles):
    data = bytearray(80) + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(v for corner in triangle for v in corner), 0)
    path.write_bytes(data)


def with_far_box(triangles, spacing, offset):
    """The grid is centered on the bounding box: the far box moves it by half the offset."""
    low = [min(c[axis] for t in triangles for c in t) for axis in range(3)]
    size = [spacing * (1.5 + o) for o in offset]
    start = [low[0] - FAR - size[0], low[1] - size[1], low[2] - size[2]]
    return triangles + box(start, [start[i] + size[i] for i in range(3)]), low[0] - 0.5 * FAR


def force_of(simulate, triangles, spacing, offset, fixed, touch, depth, radius, poisson_ratio):
    """A sphere pressed from above at the place (m) by the depth: its force (N), cycles, status."""
    shape, far = with_far_box(triangles, spacing, offset)
    with tempfile.TemporaryDirectory() as folder:
        write_stl(Path(folder) / "shape.stl", shape)
        above = [touch[0], touch[1], touch[2] + radius + 1e-4]
        below = [touch[0], touch[1], touch[2] + radius - depth]
        scene = {
            "tissue": {"shape": {"type": "mesh", "resource": "shape.stl", "scale": 1.0}, "spacing": spacing,
                       "model": "elastic",
                       "material": {"young_modulus": 10000.0, "poisson_ratio": poisson_ratio},
                       "fixed": [fixed, {"min": [-9, -9, -9], "max": [far, 9, 9]}]},
            "solver": {"method": "layered", "tolerance": 0.001},
            "tools": [{"name": "ball", "role": "push", "friction": 0.0,
                       "shapes": [{"type": "sphere", "radius": radius}]}],
            "steps": [{"move": {"tool": "ball", "from": {"xyz": above}, "to": {"xyz": below}}}]}
        (Path(folder) / "scene.yaml").write_text(yaml.safe_dump(scene))
        done = subprocess.run([simulate, Path(folder) / "scene.yaml", "--out", folder, "--quiet"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 3):
            sys.exit("walls: " + done.stderr.strip())
        tools, increments = rows_of(Path(folder) / "tools.csv"), rows_of(Path(folder) / "increments.csv")
    cycles = sorted(int(row["iterations"]) for row in increments)
    return {"force": f"{float(tools[-1]['fz']):.6g}", "cycles": cycles[len(cycles) // 2],
            "cycles_most": cycles[-1], "status": worst(increments)}


def measure(simulate):
    rows = []

    def add(case, spacing, place, **press):
        row = {"case": case, "spacing": spacing, "place": place}
        row.update(force_of(simulate, spacing=spacing, **press))
        rows.append(row)
        print(f"{case} {spacing} {place}: {row['force']} N, {row['cycles']} cycles {row['status']}", flush=True)

    dome = ring_shell(0.03, 0.003, 0.006, 24, 96)
    below = {"min": [-9, -9, -9], "max": [9, 9, 0.0]}
    for spacing in DOME_SPACINGS:
        draw = random.Random(1)
        for place in range(3 if spacing > 0.001 else 1):
            offset = [2.0 * draw.random() - 1.0 for _ in range(3)]
            add("dome", spacing, place, triangles=dome, offset=offset, fixed=below, touch=(0.0, 0.0, 0.03),
                depth=0.003, radius=0.01, poisson_ratio=0.3)
    block = box([-0.05, -0.05, -0.1], [0.05, 0.05, 0.0])
    deep = {"min": [-9, -9, -9], "max": [9, 9, -0.05]}
    for depth in (0.002, 0.005):
        for spacing in (0.005, 0.00167):  # the second one tells what is true
            draw = random.Random(3)
            for place in range(PLACES if spacing == 0.005 else 1):
                offset = [2.0 * draw.random() - 1.0 for _ in range(3)]
                add(f"block_{1e3 * depth:g}mm", spacing, place, triangles=block, offset=offset, fixed=deep,
                    touch=(0.0, 0.0, 0.0), depth=depth, radius=0.01, poisson_ratio=0.45)
    # The grid stands still along the axis that the fixed nodes end on: they would hold more or less. The kidney
    # is touched at its highest point: on a slope (kidney_slope, 25 degrees) the sphere, without friction, slides
    # from facet to facet of the mesh and bends the end aside, and small differences grow.
    kidney_held = (2, {"min": [-9, -9, -9], "max": [9, 9, -0.012]})
    organs = {"liver": ("liver", (-0.03, -0.01), 1, {"min": [-9, 0.03, -9], "max": [9, 9, 9]}),
              "kidney": ("kidney", (0.01, 0.0), *kidney_held),
              "kidney_slope": ("kidney", (0.0, 0.0), *kidney_held)}
    for case, (mesh, (x, y), still, fixed) in organs.items():
        triangles = stl_of(PACKAGE / f"config/meshes/{mesh}.stl")
        touch = (x, y, top_at(triangles, x, y))
        draw = random.Random(2)
        for place in range(PLACES):
            offset = [0.0 if axis == still else 2.0 * draw.random() - 1.0 for axis in range(3)]
            add(case, 0.005, place, triangles=triangles, offset=offset, fixed=fixed, touch=touch,
                depth=0.005, radius=0.01, poisson_ratio=0.45)
    return rows


def top_at(triangles, x, y):
    """The highest point of the surface over (x, y)."""
    top = -math.inf
    for a, b, c in triangles:
        d = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if d == 0.0:
            continue
        u = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / d
        v = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / d
        if u >= 0.0 and v >= 0.0 and u + v <= 1.0:
            top = max(top, a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]))
    return top


def show(rows):
    for case in dict.fromkeys(row["case"] for row in rows):
        for spacing in dict.fromkeys(row["spacing"] for row in rows if row["case"] == case):
            here = [row for row in rows if row["case"] == case and row["spacing"] == spacing]
            forces = [float(row["force"]) for row in here]
            middle = sum(forces) / len(forces)
            print(f"{case} {spacing}: {middle:.4g} N, from {100 * (min(forces) / middle - 1):+.1f} to "
                  f"{100 * (max(forces) / middle - 1):+.1f} %, {max(int(r['cycles_most']) for r in here)} cycles "
                  f"at most, {worst(here)}")


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        write_rows(TABLE, COLUMNS, measure(program("simulate", options.programs)))
    show(rows_of(TABLE))
