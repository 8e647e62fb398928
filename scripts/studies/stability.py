"""Runs every method through the stability ladder and draws its map.

Runs the program of test/benchmark once a rung and method, each up to the rung's limit of processor
time, and writes a row as soon as it is there: doc/data/stability.csv. What is there is not run again, unless
--again. Then draws doc/images/stability.png and prints the red cells. --plot draws and prints only.

A rung is green when all numbers are finite, every solve met its tolerance, no cell is inside out,
what was measured is within the rung's bound of the reference, and all is back at rest after the
release. doc/stability.md says what the rungs are.
"""

import math
import resource
import signal
import subprocess
import sys

from studies.common import (DATA, IMAGES, add_plot, add_programs, commit, program, progress, pyplot,
                            rows_of, write_rows)

TABLE = DATA / "stability.csv"
IMAGE = IMAGES / "stability.png"
OF_PROGRAM = ["finite", "status", "unconverged", "inverted", "error_estimate", "residual",
              "measured", "status_released", "inverted_released", "left", "iterations", "seconds"]
OF_RUNG = ["group", "unit", "bound", "has_no_shape"]
COLUMNS = ["rung", "group", "method", "verdict", "failed", "reference", "off", "unit", "bound",
           "has_no_shape", "updates", *OF_PROGRAM, "commit"]
REFERENCE = "reference"  # stands for a method; its `measured` is what the others are held against
LIMIT, RANDOM_LIMIT, REFERENCE_LIMIT = 60, 1800, 900  # s of the processor
MOST_LEFT = 0.001  # of the spacing


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


class Ladder:
    """The table, and what fills it."""

    def __init__(self, built):
        self.program = built
        self.rungs = {}
        for line in self.ask("--list").splitlines():
            name, *rest = line.split(",")
            self.rungs[name] = dict(zip(OF_RUNG, rest))
        self.rows = {(row["rung"], row["method"]): row for row in rows_of(TABLE)}
        self.commit = commit()

    def ask(self, *arguments):
        return subprocess.run([str(self.program), *arguments], stdout=subprocess.PIPE, check=True,
                              universal_newlines=True).stdout

    def run(self, rung, method, limit, updates):
        """What the program printed, or why it printed nothing."""
        done = subprocess.run([str(self.program), rung, method, str(updates)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU,
                                                                    (limit, limit + 1)))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return None, f"> {limit} s"
        if done.returncode != 0:
            return None, "refused" if done.returncode == 2 else f"exit {done.returncode}"
        return done.stdout.strip().split(","), ""

    def refer(self, rung):
        values, fault = self.run(rung, REFERENCE, REFERENCE_LIMIT, 0)
        row = {"rung": rung, "group": self.rungs[rung]["group"], "method": REFERENCE,
               "unit": self.rungs[rung]["unit"], "commit": self.commit, "failed": fault}
        if values:
            row["measured"] = "" if values[0] in ("nan", "-nan") else values[0]
            row["seconds"] = values[1]
        self.keep(row)

    def measure(self, rung, method, updates):
        is_random = self.rungs[rung]["group"] == "random"
        limit = RANDOM_LIMIT if is_random else LIMIT
        values, fault = self.run(rung, method, limit, updates)
        row = {"rung": rung, "method": method, "commit": self.commit, **self.rungs[rung]}
        row["updates"] = updates if is_random else ""
        if values:
            row.update(zip(OF_PROGRAM, values))
        else:
            row["failed"] = fault
        self.keep(row)

    def keep(self, row):
        self.rows[row["rung"], row["method"]] = row
        judge(row, self.rows)
        self.write()

    def write(self):
        order = {rung: place for place, rung in enumerate(self.rungs)}
        rows = sorted(self.rows.values(), key=lambda row: (
            order.get(row["rung"], len(order)), row["method"] != REFERENCE, row["method"]))
        write_rows(TABLE, COLUMNS, rows)


def judge(row, rows):
    """The verdict, by what was measured; `rows` by rung and method."""
    if row["method"] == REFERENCE:
        return
    reference = number(rows.get((row["rung"], REFERENCE), {}).get("measured"))
    if row.get("status"):
        elastic = row["method"] != "paper"  # which solves another model
        row["reference"] = f"{reference:.6g}" if elastic and not math.isnan(reference) else ""
        row["off"] = f"{off_of(row):.4g}" if row["reference"] else ""
        row["failed"] = "; ".join(faults_of(row))
    row["verdict"] = "red" if row["failed"] else "green"


def off_of(row):
    """Of what was measured, relative; where the reference is 0, as it is."""
    measured, reference = number(row["measured"]), number(row["reference"])
    return (measured - reference) / reference if reference else measured


def faults_of(row):
    """Short texts with the number that failed, worst first."""
    faults = []
    if row["finite"] != "1":
        faults.append("not finite")
    no_shape, random = row["has_no_shape"] == "1", row["group"] == "random"
    if int(row["inverted"]) and (random or not no_shape):
        what = "updates inverted" if random else "cells inverted"
        faults.append(f"{row['inverted']} {what}")
    if row["reference"] and not abs(number(row["off"])) <= float(row["bound"]):
        off = number(row["off"])
        relative = number(row["reference"]) != 0.0
        faults.append(f"{100 * off:+.3g} %" if relative else f"{off:.2g} {row['unit']}")
    if int(row["inverted_released"]):
        faults.append(f"{row['inverted_released']} left inverted")
    at_rest = number(row["left"]) <= MOST_LEFT
    if not at_rest:
        faults.append(f"{number(row['left']):.2g} h left")
    if no_shape and not random and int(row["inverted"]) and row["status"] == "OK":
        faults.append("inverted, said OK")
    released = row["status_released"] == "OK" or at_rest  # what is at rest need not know it
    if (row["status"] != "OK" and not no_shape) or not released:
        faults.append(f"{row['unconverged']} not OK" if random
                      else f"not OK, error {100 * number(row['error_estimate']):.2g} %")
    return faults


def draw(rows, rungs):
    plt = pyplot()
    methods = sorted({row["method"] for row in rows} - {REFERENCE},
                     key=lambda name: (name != "layered", name))
    names = [name for name in rungs if any(row["rung"] == name for row in rows)]
    cells = {(row["rung"], row["method"]): row for row in rows}
    plate, axes = plt.subplots(figsize=(2.2 + 1.35 * len(methods), 0.9 + 0.245 * len(names)))
    for line, name in enumerate(names):
        for column, method in enumerate(methods):
            row = cells.get((name, method))
            if row is None:
                continue
            red = row["verdict"] == "red"
            axes.add_patch(plt.Rectangle((column, line), 1, 1, edgecolor="white", linewidth=1.0,
                                         facecolor="#e07b6f" if red else "#8cc68a"))
            text = row["failed"].split("; ")[0] if red else text_of(row)
            axes.text(column + 0.5, line + 0.52, text, ha="center", va="center", fontsize=6.5)
    axes.set(xlim=(0, len(methods)), ylim=(len(names), 0))
    axes.set_xticks([column + 0.5 for column in range(len(methods))])
    axes.set_xticklabels(methods, fontsize=8)
    axes.set_yticks([line + 0.5 for line in range(len(names))])
    axes.set_yticklabels([name.replace("_", " ") for name in names], fontsize=7)
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    group_of = {name: rungs[name] for name in names}
    for line, (above, below) in enumerate(zip(names, names[1:]), start=1):
        if group_of[above] != group_of[below]:
            axes.axhline(line, color="0.2", linewidth=0.8)
    plate.tight_layout()
    plate.savefig(IMAGE, dpi=130, metadata={"Software": None})


def text_of(row):
    """Of a green cell: how far off the reference, or the seconds that it took."""
    if row["reference"] and number(row["reference"]):
        return f"{100 * number(row['off']):+.2g} %"
    return f"{number(row['seconds']):.2g} s"


def tell(rows):
    for row in rows:
        if row["verdict"] == "red":
            print(f"{row['method']:9} {row['rung']:16} {row['failed']}")
    for method in sorted({row["method"] for row in rows} - {REFERENCE}):
        own = [row for row in rows if row["method"] == method]
        print(f"{method}: {sum(row['verdict'] == 'green' for row in own)} of {len(own)} green")


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--methods", help="with commas between; default: simulate --list-methods")
    parser.add_argument("--only", metavar="TEXT", help="only rungs whose name holds this text")
    parser.add_argument("--again", action="store_true", help="also what is in the table")
    parser.add_argument("--updates", type=int, default=10000, help="of the random rungs")
    add_plot(parser)


def run(options):
    if not options.plot:
        ladder = Ladder(program("stability", options.programs))
        listed = subprocess.run([str(program("simulate", options.programs)), "--list-methods"],
                                check=True, stdout=subprocess.PIPE,
                                universal_newlines=True).stdout.split()
        methods = options.methods.split(",") if options.methods else listed
        unknown = sorted(set(methods) - set(listed))
        if unknown:
            sys.exit(f"stability: --methods {','.join(unknown)}: must be of {', '.join(listed)}")
        chosen = [rung for rung in ladder.rungs if (options.only or "") in rung]
        if not chosen:
            sys.exit(f"stability: no rung holds --only {options.only}; allowed: part of " +
                     ", ".join(ladder.rungs))
        climb(ladder, chosen, methods, options)
    rows = rows_of(TABLE)
    by_key = {(row["rung"], row["method"]): row for row in rows}
    for row in rows:
        judge(row, by_key)
    rungs = {row["rung"]: row["group"] for row in rows}
    draw(rows, rungs)
    tell(rows)


def climb(ladder, rungs, methods, options):
    jobs = [(rung, method) for rung in rungs for method in [REFERENCE, *methods]
            if not (method == REFERENCE and ladder.rungs[rung]["group"] == "random")]
    jobs = [job for job in jobs
            if job not in ladder.rows or options.again and job[1] != REFERENCE]
    for rung, method in progress(jobs, " ".join):
        if method == REFERENCE:
            ladder.refer(rung)
        else:
            ladder.measure(rung, method, options.updates)
    for row in ladder.rows.values():
        judge(row, ladder.rows)
    ladder.write()
