"""Tables of doc/contact_measured.md from what the study `contact` measured."""

import math

from studies.common import numbers, percentile
from studies.contact_cases import (BALLS, BOUNDS, CLEAR_MM, FEM_SPHERE, LEGS, MOST_ITERATIONS, THICK, TOOLS,
                                   dimitriadis, greatest_force, press_rows, table_of)


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


def tell_fem():
    """Of a sphere against finite elements: the force off theirs, over all places."""
    print("| spacing (mm) | " + " | ".join(f"{depth} mm deep (%)" for depth in FEM_SPHERE) + " | not OK |")
    print("|---|" + "---|" * len(FEM_SPHERE) + "---|")
    for spacing in ("2.5", "5"):
        rows = [row for row in table_of("fem") if row["spacing_mm"] == spacing]
        off = {depth: [100.0 * (float(row["force_n"]) / force - 1.0) for row in rows
                       if row["depth_mm"] == depth] for depth, force in FEM_SPHERE.items()}
        if rows:
            cells = " | ".join(f"{min(each):+.1f} to {max(each):+.1f}" for each in off.values())
            print(f"| {spacing} | {cells} | {sum(row['status'] != 'OK' for row in rows)} |")


def by_start(rows, tool, leg):
    """Of a tool's leg."""
    ways = {}
    for row in rows:
        if row["tool"] == tool and row["leg"] == leg:
            ways.setdefault(row["start"], []).append(row)
    return list(ways.values())


def started_rows(table, tool, leg):
    return by_start(table_of(table), tool, leg)


def tell_balls():
    print("| radius (mm) | off Hertz's with the layer's factor: 0.25 mm deep, 0.5 mm deep (%) | "
          "dragged, force up (N): least, greatest | greatest jump (%) | penetration, greatest (mm) | not OK |")
    print("|---|---|---|---|---|---|")
    for radius in BALLS:
        ways = {leg: started_rows("balls", f"ball:{radius}", leg) for leg in LEGS}
        if not ways["drag"]:
            continue
        off = []
        for depth in (0.25, 0.5):
            exact = dimitriadis(1e-3 * depth, 1e-3 * float(radius), THICK)
            each = [100.0 * (float(row["fz"]) / exact - 1.0) for rows in ways["press"] for row in rows
                    if float(row["way_mm"]) == CLEAR_MM + depth]
            off.append(f"{min(each):+.0f} to {max(each):+.0f}")
        up = [force for rows in ways["drag"] for force in numbers(rows, "fz")]
        jump = max(jumps_of(rows, "drag", greatest_force(rows)) for rows in ways["drag"])
        own = [row for leg in LEGS for rows in ways[leg] for row in rows]
        print(f"| {radius} | {', '.join(off)} | {min(up):.3f}, {max(up):.3f} | {jump:.1f} "
              f"| {max(numbers(own, 'penetration_mm')):.3f} "
              f"| {sum(row['status'] != 'OK' for row in own)} of {len(own)} |")


def tell_starts():
    print("| tool | dragged, penetration: median, 90 %, 99 %, greatest (mm) | more than 0.25 mm (%) | "
          "jump: median of the starts' greatest, greatest (%) | ms: median, 99 %, mean | not OK |")
    print("|---|---|---|---|---|---|")
    for tool in TOOLS:
        ways = started_rows("starts", tool, "drag")
        if not ways:
            continue
        rows = [row for way in ways for row in way]
        deep, ms = numbers(rows, "penetration_mm"), numbers(rows, "ms")
        jumps = [jumps_of(way, "drag", greatest_force(way)) for way in ways]
        print(f"| {tool.replace('_', ' ')} | "
              + ", ".join(f"{percentile(deep, share):.2f}" for share in (50, 90, 99))
              + f", {max(deep):.2f} | {100.0 * sum(one > 0.25 for one in deep) / len(deep):.0f} "
              f"| {percentile(jumps, 50):.1f}, {max(jumps):.1f} "
              f"| {percentile(ms, 50):.1f}, {percentile(ms, 99):.0f}, {sum(ms) / len(ms):.1f} "
              f"| {sum(row['status'] != 'OK' for row in rows)} of {len(rows)} |")


def tell_iterations():
    """Dragged with load steps of so many iterations at most, beside any number."""
    print("| tool | max_iterations | ms an update: median, 99 %, greatest | LATE, TOO_FAST (%) | penetration: 99 %, "
          "greatest (mm) | jump: median of the starts' greatest, greatest (%) |")
    print("|---|---|---|---|---|---|")
    bounded = table_of("iterations")
    for tool in TOOLS:
        for most in ["0"] + MOST_ITERATIONS:
            rows = [row for row in bounded if row["max_iterations"] == most] if most != "0" else table_of("starts")
            ways = by_start(rows, tool, "drag")
            if not ways:
                continue
            rows = [row for way in ways for row in way]
            deep, ms = numbers(rows, "penetration_mm"), numbers(rows, "ms")
            jumps = [jumps_of(way, "drag", greatest_force(way)) for way in ways]
            late, fast = (100.0 * sum(row["status"] == status for row in rows) / len(rows)
                          for status in ("LATE", "TOO_FAST"))
            print(f"| {tool.replace('_', ' ')} | {most} "
                  f"| {percentile(ms, 50):.1f}, {percentile(ms, 99):.0f}, {max(ms):.0f} "
                  f"| {late:.1f}, {fast:.1f} | {percentile(deep, 99):.2f}, {max(deep):.2f} "
                  f"| {percentile(jumps, 50):.1f}, {max(jumps):.1f} |")


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


def tell_all():
    for tell in (tell_press, tell_bounded, tell_slide, tell_hertz, tell_narrow, tell_fem, tell_balls, tell_starts,
                 tell_iterations, tell_friction, tell_lift, tell_rim, tell_random):
        tell()
