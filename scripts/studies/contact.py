"""Measures contact: tools pressed and dragged, a sphere on a layer, friction, a block lifted.

Runs the programs of test/benchmark (contact_press, contact_hertz, contact_friction, contact_lift, contact_rim;
contact_random only with --only random, a quarter of an hour), one after the other, each up to its
study's limit: what it wrote by then is kept. Writes doc/data/contact_*.csv to four digits, draws
doc/images/contact_press.png and contact_hertz.png from them and prints the tables of
doc/contact_measured.md. --plot draws and prints only.
"""

import csv
import math
import subprocess
import sys
from collections import namedtuple

from studies.common import (DATA, IMAGES, add_plot, add_programs, numbers, percentile, program,
                            progress, pyplot, rows_of, write_rows)


TOOLS = ["sphere", "cylinder_upright", "cylinder_lying", "box_face", "box_edge", "box_corner",
         "needle", "cup"]
LEGS = ["press", "drag", "lift"]
LEG_MM = {"press": 16.0, "drag": 30.0, "lift": 16.0}  # of contact_press
CLEAR_MM = 1.0                                        # its tools start so far above the block
BOUNDS = ["10", "5"]                                  # ms: max_ms of an update
YOUNG, POISSON = 1e4, 0.45                            # Pa, of all blocks
PRESS = ["tool", "leg", "way_mm", "fx", "fz", "penetration_mm", "ms", "status"]
HERTZ = ["spacing_mm", "radius_mm", "layer_mm", "depth_mm", "force_n", "lateral_n", "touches",
         "penetration_mm", "unbalanced_n", "ms", "status"]
NARROW = HERTZ + ["shift"]
SHIFTS = ["0", "0.1", "0.25", "0.33", "0.5"]          # spacings, along x and y: a ball off a node
FRICTION = ["tool", "friction", "spacing_mm", "way_mm", "fx", "fz", "ratio", "normal_n", "drag_n",
            "steepest", "penetration_mm", "unbalanced_n", "ms", "status", "sliding_normal_n",
            "sliding_drag_n"]
RIM = ["tool", "spacing_mm", "poisson", "friction", "offset", "depth_mm", "force_n",
       "penetration_mm", "ms", "status"]
RANDOM = ["seed", "friction", "visit", "motions", "load_steps", "not_finite", "inverted_updates",
          "inverted_at_leave", "left_mm", "greatest_force_n", "deepest_mm", "most_displacement_mm",
          "unconverged", "lost", "deepest_followed_mm"]
LIFT = ["way", "spacing_mm", "friction", "leg", "increment", "fx", "fy", "fz",
        "wrench_error_percent", "table_n", "sunk_mm", "penetration_mm", "unbalanced_n", "ms",
        "status"]

# key: rows of the table that are the study's; limit: s
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


def short(text):
    try:
        return f"{float(text):.4g}"
    except ValueError:
        return text


def store(study, lines):
    """Puts the rows of a program's output into the table in place of the study's earlier ones."""
    column, value = study.key
    rows = [row for row in table_of(study.table) if row[column] != value]
    for row in csv.DictReader(lines):
        if None not in row.values():
            rows.append({name: short(row[name]) for name in study.columns})
    order = [other.key[1] for other in STUDIES if other.table == study.table]
    rows.sort(key=lambda row: order.index(row[column]))
    write_rows(path_of(study.table), study.columns, rows)


def measure(programs, only):
    wanted = [study for study in STUDIES
              if (only or "") in study.name and (only or study.table != "random")]
    for study in progress(wanted, lambda study: study.name):
        command = ["timeout", str(study.limit), "stdbuf", "-oL",
                   str(program(study.program, programs))]
        done = subprocess.run(command + study.arguments, stdout=subprocess.PIPE,
                              universal_newlines=True, check=False)
        if done.returncode not in (0, 124):
            sys.exit(f"contact: {study.program} ended with {done.returncode}")
        store(study, done.stdout.splitlines())
        print(study.name, "cut" if done.returncode == 124 else "whole", flush=True)


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


def draw_press():
    plt = pyplot()
    plate, (upper, lower) = plt.subplots(2, 1, figsize=(9.0, 7.0), sharex=True)
    for index, tool in enumerate(TOOLS):
        rows = press_rows(tool)
        if not rows:
            continue
        way = [way_along(row) for row in rows]
        force = [math.hypot(float(row["fx"]), float(row["fz"])) for row in rows]
        look = {"linewidth": 1.0, "color": f"C{index}", "label": tool.replace("_", " ")}
        upper.plot(way, force, **look)
        lower.plot(way, numbers(rows, "penetration_mm"), **look)
    starts = [0.0, LEG_MM["press"], LEG_MM["press"] + LEG_MM["drag"]]
    for axes in (upper, lower):
        axes.grid(True, linewidth=0.3)
        for start in starts[1:]:
            axes.axvline(start, color="0.5", linewidth=0.8, linestyle="--")
    for start, leg in zip(starts, LEGS):
        upper.text(start + 0.5, 0.97, leg, transform=upper.get_xaxis_transform(), va="top")
    upper.set_ylabel("force (N)")
    lower.set_ylabel("penetration (mm)")
    lower.set_xlabel("way of the tool (mm)")
    upper.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    plate.tight_layout()
    plate.savefig(IMAGES / "contact_press.png", dpi=100)


def draw_hertz():
    rows = table_of("hertz")
    if not rows:
        return
    plt = pyplot()
    plate, axes = plt.subplots(figsize=(6.0, 4.2))
    radius, layer = (1e-3 * float(rows[0][key]) for key in ("radius_mm", "layer_mm"))
    depths = [0.05 * i for i in range(1, 81)]  # mm
    axes.plot(depths, [dimitriadis(1e-3 * d, radius, layer) for d in depths], "k-", linewidth=1.0,
              label="bonded layer (Dimitriadis et al. 2002)")
    axes.plot(depths, [hertz(1e-3 * d, radius) for d in depths], color="0.5", linestyle="--",
              linewidth=1.0, label="half-space (Hertz)")
    for spacing, marker in (("5", "x"), ("2.5", "o")):
        own = [row for row in rows if row["spacing_mm"] == spacing]
        axes.plot(numbers(own, "depth_mm"), numbers(own, "force_n"), marker, fillstyle="none",
                  label=f"spacing {spacing} mm")
    axes.set_xlabel("depth (mm)")
    axes.set_ylabel("force (N)")
    axes.grid(True, linewidth=0.3)
    axes.legend(frameon=False)
    plate.tight_layout()
    plate.savefig(IMAGES / "contact_hertz.png", dpi=100)


def jumps_of(rows, leg, most):
    """Greatest change of the force from one row of the leg to the next, in % of `most`."""
    forces = [(float(row["fx"]), float(row["fz"])) for row in rows if row["leg"] == leg]
    return max((100.0 * math.dist(a, b) / most for a, b in zip(forces, forces[1:])), default=0.0)


def tell_press():
    print("| tool | updates | greatest force (N) | penetration: median, 99 %, greatest (mm) | "
          "greatest jump: press, drag, lift (%) | ms: median, 99 %, mean | not OK |")
    print("|---|---|---|---|---|---|---|")
    for tool in TOOLS:
        rows = press_rows(tool)
        if not rows:
            continue
        most = greatest_force(rows)
        jumps = ", ".join(f"{jumps_of(rows, leg, most):.1f}" for leg in LEGS)
        deep, ms = numbers(rows, "penetration_mm"), numbers(rows, "ms")
        bad = [row for row in rows if row["status"] != "OK"]
        print(f"| {tool.replace('_', ' ')} | {len(rows)} | {most:.2f} "
              f"| {percentile(deep, 50):.3f}, {percentile(deep, 99):.3f}, {max(deep):.3f} "
              f"| {jumps} "
              f"| {percentile(ms, 50):.0f}, {percentile(ms, 99):.0f}, {sum(ms) / len(ms):.0f} "
              f"| {len(bad)} |")


def tell_bounded():
    """Updates of at most so many ms: what they take, what is late, how deep and how smooth."""
    print("| tool | max_ms | ms an update from the first contact on: median, 99 %, greatest | OK, LATE, "
          "TOO_FAST, LOST (%) | penetration: 99 %, greatest (mm) | jump: press, drag, lift (%) |")
    print("|---|---|---|---|---|---|")
    for tool in TOOLS:
        for bound in BOUNDS:
            rows = press_rows(tool, f"bounded_{bound}")
            if not rows:
                continue
            most = greatest_force(rows)
            first = next(i for i, row in enumerate(rows) if float(row["fz"]) > 0.0)
            ms = numbers(rows[first:], "ms")
            shares = [100.0 * sum(row["status"] == status for row in rows) / len(rows)
                      for status in ("OK", "LATE", "TOO_FAST", "LOST")]
            deep = numbers(rows, "penetration_mm")
            jumps = ", ".join(f"{jumps_of(rows, leg, most):.0f}" for leg in LEGS)
            print(f"| {tool.replace('_', ' ')} | {bound} | {percentile(ms, 50):.1f}, "
                  f"{percentile(ms, 99):.1f}, {max(ms):.1f} "
                  f"| {', '.join(f'{share:.0f}' for share in shares)} "
                  f"| {percentile(deep, 99):.2f}, {max(deep):.2f} | {jumps} |")


def tell_slide():
    print("| tool without friction | force aside over force up, mean of the last 10 mm dragged; greatest | "
          "jump, dragged (%) | penetration, greatest (mm) | ms: median, mean | not OK |")
    print("|---|---|---|---|---|---|")
    for tool in TOOLS:
        rows = [row for row in table_of("slide") if row["tool"] == tool]
        aside = [-float(row["fx"]) / float(row["fz"]) for row in rows if row["leg"] == "drag"]
        if not aside:
            continue
        last = aside[-len(aside) // 3:]
        most = greatest_force(rows)
        ms = numbers(rows, "ms")
        print(f"| {tool.replace('_', ' ')} | {sum(last) / len(last):.3f}; {max(map(abs, aside)):.3f} "
              f"| {jumps_of(rows, 'drag', most):.1f} | {max(numbers(rows, 'penetration_mm')):.3f} "
              f"| {percentile(ms, 50):.0f}, {sum(ms) / len(ms):.0f} "
              f"| {sum(row['status'] != 'OK' for row in rows)} |")


def tell_hertz():
    print("| spacing (mm) | depth (mm) | force (N) | layer (N) | off | touches | penetration (mm) | "
          "s | status |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row in table_of("hertz"):
        radius, layer, depth = (1e-3 * float(row[key])
                                for key in ("radius_mm", "layer_mm", "depth_mm"))
        force, exact = float(row["force_n"]), dimitriadis(depth, radius, layer)
        print(f"| {row['spacing_mm']} | {row['depth_mm']} | {force:.3f} | {exact:.3f} "
              f"| {100.0 * (force / exact - 1.0):+.1f} % | {row['touches']} "
              f"| {row['penetration_mm']} | {1e-3 * float(row['ms']):.2f} | {row['status']} |")


def tell_narrow():
    """Of balls that touch less than a spacing or so: the force off the layer's, over all places."""
    rows = table_of("narrow")
    print("| depth (mm) | contact's radius / spacing | layer (N) | off: least to greatest (%) | "
          "shown deeper than (mm) |")
    print("|---|---|---|---|---|")
    for depth in dict.fromkeys(row["depth_mm"] for row in rows):
        own = [row for row in rows if row["depth_mm"] == depth]
        radius, layer, spacing = (1e-3 * float(own[0][key])
                                  for key in ("radius_mm", "layer_mm", "spacing_mm"))
        exact = dimitriadis(1e-3 * float(depth), radius, layer)
        off = [100.0 * (float(row["force_n"]) / exact - 1.0) for row in own]
        width = math.sqrt(radius * 1e-3 * float(depth)) / spacing
        print(f"| {depth} | {width:.2f} | {exact:.4f} | {min(off):+.0f} to {max(off):+.0f} "
              f"| {max(numbers(own, 'penetration_mm')):.3f} |")


def tell_friction():
    for tool in ("plate", "box", "sphere"):
        rows = [row for row in table_of("friction") if row["tool"] == tool]
        late = [row for row in rows if float(row["way_mm"]) >= 7.0]
        if not late:
            continue
        of_touches = [float(row["drag_n"]) / float(row["normal_n"]) for row in late]
        of_sliding = [float(row["sliding_drag_n"]) / float(row["sliding_normal_n"]) for row in late
                      if float(row["sliding_normal_n"]) > 0.0]
        slide = [float(row["sliding_normal_n"]) / float(row["normal_n"]) for row in late]
        print(tool, "rows", len(rows), "to", rows[-1]["way_mm"], "mm; from 7 mm on: wrench's ratio",
              f"{min(numbers(late, 'ratio')):.4f} to {max(numbers(late, 'ratio')):.4f},",
              f"touches' {min(of_touches):.4f} to {max(of_touches):.4f},",
              f"sliding ones' {min(of_sliding):.4f} to {max(of_sliding):.4f},",
              f"which bear {min(slide):.2f} to {max(slide):.2f} of the normal force,",
              f"steepest {max(numbers(late, 'steepest')):.4f},",
              f"penetration {max(numbers(rows, 'penetration_mm')):.4f} mm,",
              f"unbalanced {max(numbers(rows, 'unbalanced_n')):.4f} N of",
              f"{max(numbers(rows, 'normal_n')):.2f} N,",
              f"ms {percentile(numbers(rows, 'ms'), 50):.0f} (most {max(numbers(rows, 'ms')):.0f}),",
              f"not OK {sum(row['status'] != 'OK' for row in rows)}")


def tell_lift():
    rows = table_of("lift")
    for leg in ("squeeze", "lift", "hold"):
        own = [row for row in rows if row["leg"] == leg]
        if not own:
            continue
        print(leg, "increments", len(own), "table",
              f"{own[0]['table_n']} to {own[-1]['table_n']} N,",
              f"error {min(numbers(own, 'wrench_error_percent')):.3f} to",
              f"{max(numbers(own, 'wrench_error_percent')):.3f} %, last",
              f"{own[-1]['wrench_error_percent']} %, sunk {own[-1]['sunk_mm']} mm,",
              f"unbalanced {max(numbers(own, 'unbalanced_n')):.4f} N,",
              f"ms {percentile(numbers(own, 'ms'), 50):.1f} (most {max(numbers(own, 'ms')):.0f}),",
              f"not OK {sum(row['status'] != 'OK' for row in own)}")


def tell_rim():
    right = {(row["poisson"], row["depth_mm"]): float(row["force_n"]) for row in table_of("rim")
             if row["tool"] == "patch"}
    print("| edges off nodes (spacings) | " + " | ".join(
        f"nu {poisson}, {float(depth):g} mm (%)" for poisson, depth in right if depth in "15") +
          " | penetration, greatest (mm) |")
    print("|---|---|---|---|---|---|")
    rows = [row for row in table_of("rim") if row["tool"] == "box"]
    for offset in sorted({row["offset"] for row in rows}, key=float):
        off = [f"{100 * (float(row['force_n']) / right[row['poisson'], row['depth_mm']] - 1):+.1f}"
               for row in rows if row["offset"] == offset and row["depth_mm"] in "15"]
        deepest = max(float(row["penetration_mm"]) for row in rows if row["offset"] == offset)
        print(f"| {offset} | {' | '.join(off)} | {deepest:.2f} |")
    print("not OK", sum(row["status"] != "OK" for row in rows), "of", len(rows))


def tell_random():
    rows = table_of("random")
    if not rows:
        return
    sums = {name: sum(int(row[name]) for row in rows)
            for name in ("motions", "load_steps", "not_finite", "inverted_updates",
                         "inverted_at_leave", "unconverged", "lost")}
    print("random", ", ".join(f"{name} {count}" for name, count in sums.items()))
    for name in ("left_mm", "greatest_force_n", "deepest_mm", "deepest_followed_mm",
                 "most_displacement_mm"):
        values = numbers(rows, name)
        print(f"  {name} of a visit: median {percentile(values, 50):.3g}, "
              f"90 % {percentile(values, 90):.3g}, greatest {max(values):.4g}")


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--only", metavar="NAME", help="only studies whose name holds this text: " +
                        ", ".join(study.name for study in STUDIES))
    add_plot(parser)


def run(options):
    if options.only and not any(options.only in study.name for study in STUDIES):
        sys.exit(f"contact: no study '{options.only}'; allowed: part of " +
                 ", ".join(study.name for study in STUDIES))
    if not options.plot:
        measure(options.programs, options.only)
    draw_press()
    draw_hertz()
    for tell in (tell_press, tell_bounded, tell_slide, tell_hertz, tell_narrow, tell_friction, tell_lift, tell_rim, tell_random):
        tell()
