"""Measures what finding contacts costs, without any solve.

Runs the program `contact_search` of test/benchmark (built on demand: make contact_search) at each
number of cells and writes doc/data/contact_search.csv with the commit; doc/contact_measured.md quotes it.
Times are of the processor, medians of 60 searches; each case is repeated, and the least told.
"""

import csv
import io
import subprocess

from studies.common import DATA, add_programs, commit, program, progress, write_rows

TABLE = DATA / "contact_search.csv"
OF_PROGRAM = ["tool", "triangles", "contacts", "search_us", "penetration_us"]


def measure(built, cells):
    done = subprocess.run([str(built), str(cells)], stdout=subprocess.PIPE, check=True,
                          universal_newlines=True)
    return list(csv.DictReader(io.StringIO(done.stdout)))


def least(runs):
    rows = []
    for same in zip(*runs):
        row = {column: same[0][column] for column in OF_PROGRAM}
        for column in ("search_us", "penetration_us"):
            row[column] = min(float(run[column]) for run in same)
        rows.append({**row, "commit": commit()})
    return rows


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--cells", default="20,40,80", help="of the block's length (20,40,80)")
    parser.add_argument("--repeat", type=int, default=5, help="runs of each case (5)")


def run(options):
    built = program("contact_search", options.programs)
    rows = []
    for cells in progress(options.cells.split(",")):
        rows += least([measure(built, int(cells)) for _ in range(options.repeat)])
    write_rows(TABLE, [*OF_PROGRAM, "commit"], rows)
    print("| tool | triangles | contacts | search (us) | penetration (us) |\n|---|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(str(row[column]) for column in OF_PROGRAM) + " |")
