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

from studies.common import (IMAGES, add_plot, add_programs, numbers, program, progress, pyplot,
                            write_rows)
from studies.contact_cases import (FEM_SPHERE, LEG_MM, LEGS, STUDIES, TOOLS, dimitriadis, hertz, path_of,
                                   press_rows, table_of, way_along)
from studies.contact_tables import tell_all


def short(text):
    try:
        return f"{float(text):.4g}"
    except ValueError:
        return text


def is_kept(study, row):
    """Of a program's output: what the tables do not tell is not kept."""
    if study.table == "fem":
        return f"{float(row['depth_mm']):g}" in FEM_SPHERE
    return row["leg"] == "drag" if study.table in ("starts", "iterations") else True


def store(study, lines):
    """Puts the rows of a program's output into the table in place of the study's earlier ones."""
    columns, values = study.key[::2], study.key[1::2]
    rows = [row for row in table_of(study.table)
            if any(row[column] != value for column, value in zip(columns, values))]
    for row in csv.DictReader(lines):
        if None not in row.values() and is_kept(study, row):
            row.update(zip(columns, values))
            rows.append({name: short(row[name]) for name in study.columns})
    order = [other.key[1::2] for other in STUDIES if other.table == study.table]
    rows.sort(key=lambda row: order.index(tuple(row[column] for column in columns)))
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
    tell_all()
