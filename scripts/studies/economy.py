"""Measures what an update costs and what is held in memory, by what there is to do.

Runs the program `economy` of test/benchmark (built on demand: make economy) at each spacing and
writes doc/data/economy.csv with the commit. doc/economy.md quotes it. Times are of the processor.
"""

import csv
import io
import subprocess

from studies.common import DATA, add_programs, commit, program, progress, write_rows

TABLE = DATA / "economy.csv"
OF_PROGRAM = ["scene", "nodes", "updates", "ms_median", "ms_90th", "ms_max", "core_percent_100hz",
              "solves", "allocations", "allocated_bytes", "heap_bytes"]


def measure(built, spacing):
    done = subprocess.run([str(built), str(spacing)], stdout=subprocess.PIPE, check=True,
                          universal_newlines=True)
    rows = list(csv.DictReader(io.StringIO(done.stdout), OF_PROGRAM))
    return [{"spacing_m": spacing, **row, "commit": commit()} for row in rows]


def add_arguments(parser):
    add_programs(parser)
    parser.add_argument("--spacings", default="0.005,0.0025", help="m (0.005,0.0025)")


def run(options):
    built = program("economy", options.programs)
    rows = [row for spacing in progress(options.spacings.split(","))
            for row in measure(built, float(spacing))]
    write_rows(TABLE, ["spacing_m", *OF_PROGRAM, "commit"], rows)
    for row in rows:
        print(f"{row['nodes']:>7} nodes  {row['scene']:<28} {row['ms_median'] or '-':>9} ms, 90th "
              f"{row['ms_90th'] or '-':>9}, {row['core_percent_100hz'] or '-':>9} % of a core, "
              f"{float(row['heap_bytes']) / int(row['nodes']):6.0f} bytes a node")
