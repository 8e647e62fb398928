"""Measures how long an increment of `layered` takes in several threads, against one.

Runs the benchmark `growth` (make growth) at three spacings of one block, where only the part that
the load disturbs is visited (tolerance 1e-2) and where all nodes are (4e-3); in 1 to as many
threads as there are processors, and in 2 and 4. Wall time, so that what else the machine does
matters: a job is run for all numbers of threads in turn, which makes a round, until there are
enough rounds in which other programs took less than QUIET of a processor; where there are not, the
quietest count. Medians of the ratios in each round. What the machine itself could give at most is
measured beside it: as many processes at once as there are processors, each with a job of its own in
one thread; time over the number of jobs, of one job alone. Writes doc/data/threads.csv, draws
doc/images/threads.png, prints a table. What the table has of quiet rounds stays, but with --anew.
--plot draws and prints only.
"""

import concurrent.futures
import os
import resource
import statistics
import time


from studies import growth
from studies.common import (DATA, IMAGES, add_plot, add_programs, program, progress, pyplot,
                            rows_of, write_rows)

TABLE = DATA / "threads.csv"
PLOT = IMAGES / "threads.png"
THREADS = sorted({*range(1, len(os.sched_getaffinity(0)) + 1), 2, 4})
# Spacing (m) of 100 x 100 x 50 mm, times the way is gone in a run.
SPACINGS = [(0.005, 20), (0.0025, 5), (0.00125, 1)]
TOLERANCES = [(0.01, "a part visited"), (0.004, "all visited")]
RATIO = 0.45
QUIET = 0.05
TRIES = 2  # times the rounds that are asked for


def processor_seconds():
    """Of the whole machine, and of the programs that this one has run."""
    with open("/proc/stat", encoding="ascii") as stat:
        user, nice, system, _, _, *more = map(int, stat.readline().split()[1:9])
    own = resource.getrusage(resource.RUSAGE_CHILDREN)
    return ((user + nice + system + sum(more)) / os.sysconf("SC_CLK_TCK"),
            own.ru_utime + own.ru_stime)


def round_of(built, job, repeats):
    """A row for each number of threads; how many processors other programs had meanwhile."""
    start, (busy, own) = time.monotonic(), processor_seconds()
    rows = [growth.run_once(built, (*job, threads), RATIO, repeats) for threads in THREADS]
    at_once = wall_at_once(built, (*job, 1), repeats) / float(rows[0]["wall_ms"])
    for row in rows:
        row["machine"] = at_once
    busy_now, own_now = processor_seconds()
    passed = time.monotonic() - start
    return max(0.0, (busy_now - busy) - (own_now - own)) / passed, rows


def wall_at_once(built, job, repeats):
    """Of processes that do not wait for each other: time over the number of jobs that are done."""
    processors = len(os.sched_getaffinity(0))
    with concurrent.futures.ThreadPoolExecutor(processors) as pool:
        runs = [pool.submit(growth.run_once, built, job, RATIO, repeats)
                for _ in range(processors)]
    return 1.0 / sum(1.0 / float(run.result()["wall_ms"]) for run in runs)


def quiet_rounds(built, job, repeats, wanted):
    rounds = []
    for _ in range(TRIES * wanted):
        rounds.append(round_of(built, job, repeats))
        if sum(others < QUIET for others, _ in rounds) == wanted:
            break
    return sorted(rounds, key=lambda one: one[0])[:wanted]


def rows_of_rounds(job, rounds):
    spacing, _, tolerance = job
    for number, threads in enumerate(THREADS):
        each = [rows[number] for _, rows in rounds]
        shares = [float(rows[number]["wall_ms"]) / float(rows[0]["wall_ms"]) for _, rows in rounds]
        yield {"spacing_m": spacing, "tolerance": tolerance, "poisson_ratio": RATIO,
               "nodes": each[0]["nodes"], "active_nodes": each[0]["active_nodes"],
               "processors": len(os.sched_getaffinity(0)), "threads": threads,
               "rounds": len(rounds), "others_most": f"{rounds[-1][0]:.3f}",
               "wall_ms": f"{statistics.median(float(row['wall_ms']) for row in each):.4g}",
               "of_one": f"{statistics.median(shares):.3f}",
               "of_one_least": f"{min(shares):.3f}", "of_one_most": f"{max(shares):.3f}",
               "machine": f"{statistics.median(rows[number]['machine'] for _, rows in rounds):.3f}",
               "not_ok": max(int(row["not_ok"]) for row in each)}


def measure(built, wanted, anew):
    known = [] if anew or not TABLE.exists() else [job for _, job in jobs_of_table()]
    rows = []
    jobs = [(tolerance, *spacing) for tolerance, _ in TOLERANCES for spacing in SPACINGS]
    for tolerance, spacing, repeats in progress(jobs):
        job = (spacing, 1, tolerance)
        quiet = [one for one in known if one and float(one[0]["others_most"]) < QUIET
                 and (float(one[0]["spacing_m"]), float(one[0]["tolerance"])) == job[::2]]
        rows += quiet[0] if quiet else rows_of_rounds(
            job, quiet_rounds(built, job, repeats, wanted))
    write_rows(TABLE, rows[0].keys(), rows)


def jobs_of_table():
    rows = rows_of(TABLE)
    for tolerance, name in TOLERANCES:
        for spacing, _ in SPACINGS:
            job = [row for row in rows if (float(row["tolerance"]), float(row["spacing_m"]))
                   == (tolerance, spacing)]
            yield name, job


def draw():
    plt = pyplot()
    figure, plots = plt.subplots(1, len(TOLERANCES), figsize=(8, 3.8), sharey=True)
    for plot, (_, title) in zip(plots, TOLERANCES):
        for (name, job), style in zip([one for one in jobs_of_table() if one[0] == title],
                                      ("o-", "s--", "^:")):
            threads = [int(row["threads"]) for row in job]
            shares, least, most = ([float(row[key]) for row in job]
                                   for key in ("of_one", "of_one_least", "of_one_most"))
            ends = [[one - low for one, low in zip(shares, least)],
                    [high - one for one, high in zip(shares, most)]]
            plot.errorbar(threads, shares, ends, fmt=style, capsize=3,
                          label=f"{int(job[0]['nodes']):,} nodes")
        plot.axhline(1.0, color="gray", linewidth=0.8)
        processors = int(job[0]["processors"])
        plot.axvline(processors, color="gray", linewidth=0.8, linestyle=":")
        plot.set_title(f"{title}, {processors} processors", fontsize=10)
        plot.set_xticks(threads)
        plot.set_xlabel("threads")
        plot.grid(True, axis="y", alpha=0.4)
        plot.legend(fontsize=8)
    plots[0].set_ylabel("time of an increment, of that in one thread")
    plots[0].set_ylim(bottom=0.0)
    figure.tight_layout()
    figure.savefig(PLOT, dpi=110)


def tell():
    print("| nodes | | nodes visited | threads | ms | of one thread: median (least to most) "
          "| jobs at once |")
    print("|---|---|---|---|---|---|---|")
    for name, job in jobs_of_table():
        for row in job:
            spread = f" ({float(row['of_one_least']):.2f} to {float(row['of_one_most']):.2f})"
            print(f"| {int(row['nodes']):,} | {name} | {int(row['active_nodes']):,} "
                  f"| {row['threads']} | {float(row['wall_ms']):.3g} | "
                  + ("1 " if row["threads"] == "1" else f"{float(row['of_one']):.2f}{spread} ")
                  + f"| {float(row['machine']):.2f} |")


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)
    parser.add_argument("--anew", action="store_true", help="quiet rounds of the table, too")
    parser.add_argument("--rounds", type=int, default=7)


def run(options):
    if not options.plot:
        measure(program("growth", options.programs), options.rounds, options.anew)
    draw()
    tell()
