"""Draws doc/data/study.csv.gz: speed against accuracy, cost against nodes, and the tables of
doc/speed_accuracy.md. `scripts/study speed_accuracy --plot` calls it.

A point is a method at a tolerance on lattices of one size: geometric means over the cases, whiskers
from the fastest to the slowest repeat. A point counts only if all its cases are OK.
"""

import math
import sys
from collections import defaultdict

from studies.common import IMAGES, PACKAGE, pyplot, rows_of
from studies.speed_accuracy_cases import CHARTED as CASES


SPEED = IMAGES / "speed_accuracy.png"
COST = IMAGES / "cost_nodes.png"
PAGE = PACKAGE / "doc/speed_accuracy.md"
BEGIN, END = "<!-- tables of scripts/study speed_accuracy --plot -->\n", "<!-- end of tables -->\n"

RATIOS = {"elastic": ("0.25", "0.45"), "six_spring": ("",), "tetrahedra": ("0.25", "0.45"),
          "links": ("",)}
WITH_SOLVER_ERROR = ("elastic", "tetrahedra", "links")
LEVELS = (0.10, 0.03, 0.01, 0.003, 0.001)
COST_TOLERANCE = "0.01"
COLORS = {"layered": "tab:red", "newton": "tab:blue", "paper": "0.4", "vbd": "tab:green",
          "xpbd": "tab:orange", "explicit": "tab:purple", "bullet_soft": "tab:brown",
          "bullet_deformable": "tab:pink"}


def mean(values):
    """Geometric; values of 0 count as 1e-12."""
    return math.exp(sum(math.log(max(value, 1e-12)) for value in values) / len(values))


class Point:
    """A method at a tolerance on lattices of one size."""

    def __init__(self, rows):
        first = rows[0]
        self.method, self.model, self.tolerance = (first["method"], first["model"],
                                                   first["tolerance"])
        self.nodes = int(first["nodes"])
        wanted = [(case, ratio) for case in CASES for ratio in RATIOS[self.model]]
        by_case = defaultdict(list)
        for row in rows:
            by_case[row["case"], row["poisson_ratio"]].append(row)
        solved = [key for key in wanted
                  if by_case[key] and all(row["status"] == "OK" for row in by_case[key])]
        self.cases, self.solved = len(wanted), len(solved)
        self.ok = self.solved == self.cases
        if not solved:
            return
        times = {key: [float(row["ms_median"]) for row in by_case[key]] for key in solved}
        self.ms = mean([mean(values) for values in times.values()])
        self.ms_range = [mean([pick(values) for values in times.values()]) for pick in (min, max)]
        self.solver_error = self.mean_of(by_case, solved, "solver_error")
        self.whole_error = self.mean_of(by_case, solved, "field_error")

    @staticmethod
    def mean_of(by_case, keys, column):
        found = [by_case[key][0][column] for key in keys]
        return mean([float(value) for value in found]) if all(found) else None


def points_of(rows):
    groups = defaultdict(list)
    for row in rows:
        if row["case"] in CASES and row["poisson_ratio"] in RATIOS.get(row["model"], ()):
            groups[row["model"], row["method"], row["tolerance"], int(row["nodes"])].append(row)
    points = [Point(group) for group in groups.values()]
    return [point for point in points if point.solved > 0]


def front_of(pairs):
    """Those (error, ms) that no other beats in both, by rising error."""
    front = []
    for error, ms in sorted(pairs):
        if not front or ms < front[-1][1]:
            front.append((error, ms))
    return front


def draw_front(axes, pairs):
    front = front_of(pairs)
    if front:
        errors, times = zip(*front)
        axes.step(errors, times, where="post", color="0.75", linewidth=5, zorder=0,
                  label="Pareto front")


def draw_lines(axes, points, error_of):
    """A line a method and size, over its tolerances; hollow where not all cases are solved."""
    lines = defaultdict(list)
    for point in points:
        if error_of(point) is not None and error_of(point) > 0.0:
            lines[point.method, point.nodes].append(point)
    sizes = sorted({nodes for _, nodes in lines})
    named = set()
    for (method, nodes), line in sorted(lines.items()):
        line.sort(key=error_of)
        color = COLORS.get(method, "black")
        marker = "osD^v"[sizes.index(nodes) % 5] if len(sizes) > 1 else "o"
        label = None if method in named else method
        named.add(method)
        errors, times = [error_of(p) for p in line], [p.ms for p in line]
        spread = [[p.ms - p.ms_range[0] for p in line], [p.ms_range[1] - p.ms for p in line]]
        axes.errorbar(errors, times, yerr=spread, color=color, linewidth=1.0, capsize=2,
                      label=label)
        for point in line:
            axes.plot(error_of(point), point.ms, marker=marker, color=color, markersize=5,
                      markerfacecolor=color if point.ok else "white")
    for size, marker in zip(sizes if len(sizes) > 1 else [], "osD^v"):
        axes.plot([], [], marker, color="0.4", markersize=5, label=f"{size:,} nodes")
    draw_front(axes, [(error_of(p), p.ms) for line in lines.values() for p in line if p.ok])


def finish(axes, title, xlabel):
    axes.set(xscale="log", yscale="log", title=title, xlabel=xlabel,
             ylabel="ms per 1 mm increment")
    axes.grid(True, which="major", linewidth=0.3)
    if axes.has_data():
        axes.legend(fontsize=6.5, frameon=False)


def solver_error(point):
    """None of those that the others are held against."""
    return None if point.tolerance == "" else point.solver_error


def whole_error(point):
    return point.whole_error


def draw_speed(points):
    plt = pyplot()
    elastic = [point for point in points if point.model in WITH_SOLVER_ERROR]
    sizes = sorted({point.nodes for point in elastic})[:3]
    plate, panels = plt.subplots(2, 2, figsize=(11.0, 9.0))
    for axes, nodes in zip(panels.flat, sizes):
        draw_lines(axes, [point for point in elastic if point.nodes == nodes], solver_error)
        finish(axes, f"the solver's error, {nodes:,} nodes",
               "displacement error against the equilibrium of the same lattice")
    for axes in list(panels.flat)[len(sizes):3]:
        axes.axis("off")
    draw_lines(panels.flat[3], points, whole_error)
    finish(panels.flat[3], "the whole error", "displacement error against finite elements")
    plate.tight_layout()
    plate.savefig(SPEED, dpi=110, metadata={"Software": None})
    plt.close(plate)


def draw_cost(points):
    plt = pyplot()
    plate, axes = plt.subplots(figsize=(6.0, 4.5))
    lines = defaultdict(list)
    for point in points:
        if point.tolerance == COST_TOLERANCE or point.method == "newton":
            lines[point.method].append(point)
    for method, line in sorted(lines.items()):
        line.sort(key=lambda point: point.nodes)
        spread = [[p.ms - p.ms_range[0] for p in line], [p.ms_range[1] - p.ms for p in line]]
        axes.errorbar([p.nodes for p in line], [p.ms for p in line], yerr=spread, marker="o",
                      markersize=4, capsize=2, color=COLORS.get(method, "black"), label=method)
    finish(axes, f"cost at a tolerance of {COST_TOLERANCE}", "nodes")
    plate.tight_layout()
    plate.savefig(COST, dpi=110, metadata={"Software": None})
    plt.close(plate)


def reach_table(points, error_of, nodes):
    """Least ms at which each method stays below each error."""
    methods = sorted({point.method for point in points if error_of(point) is not None})
    lines = ["| method | " + " | ".join(f"{100 * level:g} %" for level in LEVELS) + " | best |",
             "|---" * (len(LEVELS) + 2) + "|"]
    for method in methods:
        own = [p for p in points if p.method == method and p.nodes == nodes and p.ok
               and error_of(p) is not None]
        cells = []
        for level in LEVELS:
            times = [p.ms for p in own if error_of(p) <= level]
            cells.append(f"{min(times):.3g}" if times else "-")
        best = min(own, key=error_of, default=None)
        cells.append(f"{100 * error_of(best):.2g} % at {best.ms:.3g}" if best else "not all cases")
        lines.append(f"| {method} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def failures_table(rows):
    """Runs that did not end OK, counted."""
    found = defaultdict(int)
    for row in rows:
        if row["repeat"] == "1" and row["status"] != "OK":
            key = (row["method"], row["case"], row["poisson_ratio"],
                   f"{1e3 * float(row['spacing_m']):g} mm", row["status"])
            found[key] += 1
    if not found:
        return "All runs ended OK.\n"
    lines = ["| method | case | nu | spacing | status | tolerances |", "|---" * 6 + "|"]
    lines += ["| " + " | ".join(key) + f" | {count} |" for key, count in sorted(found.items())]
    return "\n".join(lines) + "\n"


def tables(rows, points):
    elastic = [point for point in points if point.model in WITH_SOLVER_ERROR]
    one_of = {column: ", ".join(sorted({row[column] for row in rows}))
              for column in ("commit", "machine", "compiler")}
    text = (f"Measured on {one_of['machine']} with {one_of['compiler']}, commit "
            f"{one_of['commit']}; {len(rows)} runs.\n")
    for nodes in sorted({point.nodes for point in elastic}):
        text += (f"\n**{nodes:,} nodes: milliseconds per 1 mm increment at which the solver's error "
                 "stays below**\n\n" + reach_table(elastic, solver_error, nodes))
    return text + "\n**Runs that did not end OK**\n\n" + failures_table(rows)


def draw(table):
    if not table.is_file():
        sys.exit(f"study: no table at {table}; run scripts/study speed_accuracy first")
    rows = rows_of(table)
    points = points_of(rows)
    if not points:
        sys.exit(f"study: {table} has no case of " + ", ".join(CASES))
    SPEED.parent.mkdir(parents=True, exist_ok=True)
    draw_speed(points)
    draw_cost(points)
    page = PAGE.read_text()
    head, rest = page.split(BEGIN)
    PAGE.write_text(head + BEGIN + tables(rows, points) + END + rest.split(END)[1])
    print(f"wrote {SPEED.relative_to(PACKAGE)}, {COST.relative_to(PACKAGE)} and the tables of "
          f"{PAGE.relative_to(PACKAGE)}")
