"""What holds a tool back that is dragged through the block of contact_press, by how deep it is.

Tools are pressed in, dragged by 30 mm, 0.25 mm an update, and drawn out, without friction and with
0.3, at two spacings. By symmetry nothing holds back a tool without friction in the middle of the
block; with friction that alone does, where the tool is flat. Writes doc/data/slides.csv with the
commit and prints the table of doc/contact_measured.md. Some minutes.
"""

import csv
import math
import subprocess
import sys

from studies.common import DATA, add_plot, add_programs, commit, program, progress, rows_of, write_rows

TABLE = DATA / "slides.csv"
COLUMNS = ["tool", "friction", "spacing_mm", "press_mm", "up_n", "aside_over_up", "least", "greatest", "jump_percent",
           "penetration_mm", "ms_mean", "updates", "not_ok", "commit"]
TOOLS = ["box_face", "cylinder_upright", "sphere", "box_edge"]
CASES = [(tool, friction, "5", press) for tool in TOOLS for friction in ("0", "0.3") for press in ("4", "8", "12")]
CASES += [(tool, friction, "2.5", "4") for tool in TOOLS[:2] for friction in ("0", "0.3")]
LAST = 80  # updates of the drag that count, of 120: before, tools with friction do not slide yet


def measure(contact_press, case):
    tool, friction, spacing, press = case
    output = subprocess.run([str(contact_press), tool, "0", spacing, friction, "layered", "0.01", press],
                            stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
    rows = list(csv.DictReader(output.splitlines()))
    forces = [(float(row["fx"]), float(row["fz"])) for row in rows if row["leg"] == "drag"]
    most = max(math.hypot(*force) for force in forces)
    late = forces[-LAST:]
    aside = [-x / z for x, z in late]
    return {"tool": tool, "friction": friction, "spacing_mm": spacing, "press_mm": press,
            "up_n": f"{sum(z for _, z in late) / LAST:.2f}", "aside_over_up": f"{sum(aside) / LAST:.3f}",
            "least": f"{min(aside):.2f}", "greatest": f"{max(aside):.2f}",
            "jump_percent": f"{max(100.0 * math.dist(a, b) / most for a, b in zip(late, late[1:])):.1f}",
            "penetration_mm": f"{max(float(row['penetration_mm']) for row in rows):.2f}",
            "ms_mean": f"{sum(float(row['ms']) for row in rows) / len(rows):.1f}", "updates": len(rows),
            "not_ok": sum(row["status"] != "OK" for row in rows), "commit": commit()}


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        contact_press = program("contact_press", options.programs)
        write_rows(TABLE, COLUMNS, [measure(contact_press, case) for case in progress(CASES, " ".join)])
    rows = rows_of(TABLE)
    if not rows:
        sys.exit(f"slides: {TABLE} is not there: measure first")
    print("| tool, spacing (mm) | friction | pressed (mm) | force up (N) | force aside over it: mean; least, greatest | "
          "jump (%) | penetration, greatest (mm) | ms an update | not OK |\n|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        print("| {}, {spacing_mm} | {friction} | {press_mm} | {up_n} | {aside_over_up}; {least}, {greatest} "
              "| {jump_percent} | {penetration_mm} | {ms_mean} | {not_ok} of {updates} |".format(
                  row["tool"].replace("_", " "), **row))
