"""What the study `contact` runs and where it keeps it; formulas that its results are compared with."""

import math
from collections import namedtuple

from studies.common import DATA, rows_of

TOOLS = ["sphere", "cylinder_upright", "cylinder_lying", "box_face", "box_edge", "box_corner",
         "needle", "cup"]
LEGS = ["press", "drag", "lift"]
LEG_MM = {"press": 16.0, "drag": 30.0, "lift": 16.0}  # of contact_press
CLEAR_MM = 1.0                                        # its tools start so far above the block
BOUNDS = ["10", "5"]                                  # ms: max_ms of an update
YOUNG, POISSON = 1e4, 0.45                            # Pa, of all blocks
THICK = 0.05                                          # m, of contact_press's block
PRESS = ["tool", "leg", "way_mm", "fx", "fz", "penetration_mm", "ms", "status"]
HERTZ = ["spacing_mm", "radius_mm", "layer_mm", "depth_mm", "force_n", "lateral_n", "touches",
         "penetration_mm", "unbalanced_n", "ms", "status"]
NARROW = HERTZ + ["shift"]
SHIFTS = ["0", "0.1", "0.25", "0.33", "0.5"]          # spacings, along x and y: a ball off a node
FRICTION = ["tool", "friction", "spacing_mm", "way_mm", "fx", "fz", "ratio", "normal_n", "drag_n",
            "steepest", "penetration_mm", "unbalanced_n", "ms", "status", "sliding_normal_n",
            "sliding_drag_n"]
FEM = NARROW + ["shift_y"]
# Places of a ball between four nodes (spacings along x and y): above a node, the middle of a face, that of an edge.
PLACES = [("0", "0"), ("0.5", "0.5"), ("0.5", "0"), ("0.25", "0.1"), ("0.3", "0.45")]
BALLS = ["2.5", "3", "5", "8"]                        # mm: radius
BALL_PRESS_MM = "3"
STARTS = ["0 0", "1.3 -0.7", "2.1 1.6", "3.7 2.9"]    # mm: off contact_press's usual one
MOST_ITERATIONS = ["18", "36"]                        # max_iterations of a load step
STARTED = ["tool", "start", "leg", "way_mm", "fx", "fz", "penetration_mm", "ms", "status"]
# Force (N) on a frictionless sphere of 20 mm by its depth (mm) in a disc of the area of 100 x 100 mm, 50 mm thick, nu
# 0.49, neo-Hookean: axisymmetric quadratic finite elements of our own.
FEM_SPHERE = {"1": 0.0840, "2": 0.2444, "3": 0.4582}
RIM = ["tool", "spacing_mm", "poisson", "friction", "offset", "depth_mm", "force_n",
       "penetration_mm", "ms", "status"]
RANDOM = ["seed", "friction", "visit", "motions", "load_steps", "not_finite", "inverted_updates",
          "inverted_at_leave", "left_mm", "greatest_force_n", "deepest_mm", "most_displacement_mm",
          "unconverged", "lost", "deepest_followed_mm"]
LIFT = ["way", "spacing_mm", "friction", "leg", "increment", "fx", "fy", "fz",
        "wrench_error_percent", "table_n", "sunk_mm", "penetration_mm", "unbalanced_n", "ms",
        "status"]

# key: rows of the table that are the study's, by columns and their values in turn; limit: s
Study = namedtuple("Study", "name table columns program arguments key limit")
STUDIES = [Study(f"press_{tool}", "press", PRESS, "contact_press", [tool, "0", "5", "0.3"],
                 ("tool", tool), 42) for tool in TOOLS]
STUDIES += [Study(f"slide_{tool}", "slide", PRESS, "contact_press", [tool, "0", "5", "0"],
                  ("tool", tool), 60) for tool in TOOLS if tool not in ("needle", "cup")]
STUDIES += [Study(f"bounded_{bound}_{tool}", f"bounded_{bound}", PRESS, "contact_press",
                  [tool, "0", "5", "0.3", "layered", "0.01", "15", bound], ("tool", tool), 60)
            for bound in BOUNDS for tool in TOOLS]
STUDIES += [Study(f"hertz_{spacing}", "hertz", HERTZ, "contact_hertz",
                  [spacing, "40", "50", "160", "4", "8"], ("spacing_mm", spacing), 110)
            for spacing in ("2.5", "5")]
STUDIES += [Study(f"narrow_{shift}", "narrow", NARROW, "contact_hertz",
                  ["5", "20", "50", "100", "2", "8", "layered", "0.01", shift], ("shift", shift), 60)
            for shift in SHIFTS]
STUDIES += [Study(f"fem_{spacing}_{x}_{y}", "fem", FEM, "contact_hertz",
                  [spacing, "20", "50", "100", "3", "30", "layered", "0.01", x, y, "0.49"],
                  ("spacing_mm", spacing, "shift", x, "shift_y", y), 120)
            for spacing in ("2.5", "5") for x, y in PLACES]
# Of contact_press's start (36.3, 51.1) mm the next node is (40, 50).
STUDIES += [Study(f"ball_{radius}_{x}_{y}", "balls", STARTED, "contact_press",
                  [f"ball:{radius}", "0", "5", "0", "layered", "0.01", BALL_PRESS_MM, "0", *start.split()],
                  ("tool", f"ball:{radius}", "start", start), 60)
            for radius in BALLS for x, y in PLACES
            for start in [f"{3.7 + 5 * float(x):g} {-1.1 + 5 * float(y):g}"]]
# In turns: their times are compared.
for tool in TOOLS:
    for start in STARTS:
        way = [tool, "0", "5", "0.3", "layered", "0.01", "15", "0", *start.split()]
        name = f"{tool}_{start.replace(' ', '_')}"
        STUDIES.append(Study(f"start_{name}", "starts", STARTED, "contact_press", way, ("tool", tool, "start", start),
                             60))
        STUDIES += [Study(f"start_of_{most}_{name}", "iterations", STARTED + ["max_iterations"], "contact_press",
                          way + [most], ("tool", tool, "start", start, "max_iterations", most), 60)
                    for most in MOST_ITERATIONS]
STUDIES += [Study(f"friction_{tool}", "friction", FRICTION, "contact_friction", [tool, "0.3", "5"],
                  ("tool", tool), 40) for tool in ("plate", "box", "sphere")]
STUDIES += [Study("lift", "lift", LIFT, "contact_lift", ["grasp", "0.5", "10"], ("way", "grasp"),
                  60)]
STUDIES += [Study(f"rim_{tool}", "rim", RIM, "contact_rim", [tool, spacing], ("tool", tool), 60)
            for tool, spacing in (("patch", "2.5"), ("box", "5"))]
STUDIES += [Study(f"random_{seed}", "random", RANDOM, "contact_random", ["2500", "0.3", "10", seed],
                  ("seed", seed), 3600) for seed in "1234"]


def path_of(table):
    return DATA / f"contact_{table}.csv"


def table_of(name):
    return rows_of(path_of(name))


def dimitriadis(depth, radius, layer):
    """Force (N) of a sphere on a layer bonded to its ground (m), to fourth order in
    sqrt(radius depth) / layer: Dimitriadis et al., Biophysical Journal 82 (2002) 2798."""
    nu = POISSON
    a = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1.0 - nu)
    b = (0.6387 - 1.0277 * nu + 1.5164 * nu**2) / (1.0 - nu)
    x = math.sqrt(radius * depth) / layer
    of_layer = (1.0 - 2.0 * a / math.pi * x + 4.0 * a**2 / math.pi**2 * x**2 -
                8.0 / math.pi**3 * (a**3 + 4.0 * math.pi**2 / 15.0 * b) * x**3 +
                16.0 * a / math.pi**4 * (a**3 + 3.0 * math.pi**2 / 5.0 * b) * x**4)
    return hertz(depth, radius) * of_layer


def hertz(depth, radius):
    """Force (N) on a half-space."""
    return 4.0 / 3.0 * YOUNG / (1.0 - POISSON**2) * math.sqrt(radius) * depth**1.5


def way_along(row):
    """Way (mm) since the tool stood above the block."""
    before = sum(LEG_MM[leg] for leg in LEGS[:LEGS.index(row["leg"])])
    return before + float(row["way_mm"])


def press_rows(tool, table="press"):
    return [row for row in table_of(table) if row["tool"] == tool and row["leg"] in LEGS]


def greatest_force(rows):
    return max(math.hypot(float(row["fx"]), float(row["fz"])) for row in rows)
