"""A robot of a palm and three fingers, each a mesh of 3,000 triangles, for the studies of the node."""

import math
import struct

BUMP = 0.04                             # of the radius
SIDES, RINGS = 50, 32                   # 2 SIDES (RINGS - 2) triangles; the first and last ring are the tips
FINGER, PALM = (0.008, 0.045), (0.025, 0.08)    # radius and length of a capsule (m)
LINKS = {"palm": PALM, "thumb": FINGER, "index": FINGER, "middle": FINGER}
# Where the tips of a tool's links are (m): x and y off its middle, z over its lowest point.
HAND = {"palm": (0.0, 0.0, 0.04), "index": (-0.012, 0.0, 0.0), "middle": (0.012, 0.0, 0.0)}
FINGERS = {"thumb": (-0.018, 0.0, 0.0), "index": (0.012, -0.014, 0.0), "middle": (0.012, 0.014, 0.0)}

ROBOT = '<robot name="hand">\n  <link name="base"/>\n{}</robot>\n'
LINK = """  <link name="{name}">
    <collision><geometry><mesh filename="file://{mesh}"/></geometry></collision>
  </link>
  <joint name="{name}_slide" type="floating"><parent link="base"/><child link="{name}"/></joint>
"""


def place(ring, side, radius, length):
    """A point of the surface: the lower tip, ring 0, is the origin, and it goes up along z."""
    straight = length - 2 * radius
    way = ring / (RINGS - 1) * (math.pi * radius + straight)     # from tip to tip
    middle = min(max(way - 0.5 * math.pi * radius, 0.0), straight)
    bend = (way - middle) / radius
    turn = 2 * math.pi * (side % SIDES) / SIDES
    out = radius * math.sin(bend) if 0 < ring < RINGS - 1 else 0.0
    out *= 1 + BUMP * math.cos(5 * turn) * math.cos(400.0 * way)
    return out * math.cos(turn), out * math.sin(turn), radius * (1 - math.cos(bend)) + middle


def triangles(radius, length):
    for ring in range(RINGS - 1):
        for side in range(SIDES):
            a, b = place(ring, side, radius, length), place(ring, side + 1, radius, length)
            c, d = place(ring + 1, side + 1, radius, length), place(ring + 1, side, radius, length)
            if ring > 0:
                yield a, b, c
            if ring < RINGS - 2:
                yield a, c, d


def write_mesh(path, radius, length):
    facets = list(triangles(radius, length))
    with path.open("wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            file.write(struct.pack("<12fH", 0.0, 0.0, 0.0, *(x for corner in facet for x in corner), 0))


def write(folder):
    """The meshes, and the URDF, whose path is returned."""
    for name, (radius, length) in LINKS.items():
        write_mesh(folder / f"{name}.stl", radius, length)
    robot = folder / "hand.urdf"
    robot.write_text(ROBOT.format("".join(LINK.format(name=name, mesh=folder / f"{name}.stl") for name in LINKS)))
    return robot
