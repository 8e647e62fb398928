"""Runs every method on every case, spacing and tolerance, and collects doc/data/study.csv.gz.

Writes scenes and a list of independent `simulate` commands to the work folder and runs them with GNU
parallel. Stopped at any point, it goes on with what is not finished when started again: a run is
finished when its folder has its exit code, which is written last. Rows of finished runs are kept with
the commit they were measured on; --again drops them. Bullet, the outside peer, is run by `bullet_peer`
beside `simulate`, where that is built.

One job at a time by default, so that times are not those of a busy machine. Over several machines:
--sshlogin 1/one,1/two (host names as ssh knows them, password-less, each with rsync, GNU parallel's
needs, and with the package built; --simulate is the runner's path there and here).
"""

import ctypes
import fcntl
import re
import shlex
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies import accuracy, speed_accuracy_cases, speed_accuracy_charts
from studies.common import (DATA, PACKAGE, WORST_LAST, commit, compiler_of, program, rows_of,
                            write_rows)

TABLE = DATA / "study.csv.gz"
COLUMNS = ["method", "model", "spacing_m", "nodes", "tolerance", "poisson_ratio", "case", "repeat",
           "status", "increments", "ms_median", "ms_min", "ms_max", "ms_first", "solver_error",
           "field_error", "force_n", "force_error", "commit", "machine", "compiler"]
TIMED_OUT = 124  # of timeout(1)
FINISHED = {"0", "1", "2", "3", str(TIMED_OUT)}


def ask(simulate, *arguments):
    done = subprocess.run([str(simulate), *arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True, check=False)
    return done.returncode, done.stdout.split()


def fitting(simulate, methods, model):
    """The methods that solve scenes of this model at all."""
    scene = {"tissue": speed_accuracy_cases.block(0.25, 0.025, model), "steps": [{"settle": {}}]}
    found = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(yaml.safe_dump(scene))
        for method in methods:
            code, _ = ask(simulate, str(file), "--out", folder, "--method", method, "--quiet")
            if code in (0, 3):
                found.append(method)
    return found


def peers_of(peer):
    """Bullet's methods, none where its program is not built."""
    if peer.is_file():
        return ask(peer, "--list-methods")[1]
    print(f"study: no rows of Bullet: {peer} is not built (needs Debian's libbullet-dev, then "
          "`make bullet_peer` in the build folder)", file=sys.stderr)
    return []


def planned(simulate, peer, options):
    own, peers = ask(simulate, "--list-methods")[1], peers_of(peer)
    known = own + peers
    methods = options.methods.split(",") if options.methods else known
    unknown = sorted(set(methods) - set(known))
    if unknown:
        sys.exit(f"study: --methods {','.join(unknown)}: must be of {', '.join(known)}")
    fit = {model: fitting(simulate, [method for method in methods if method in own], model)
           for model in ask(simulate, "--list-models")[1]}
    for method in set(methods) & set(peers):
        fit.setdefault(speed_accuracy_cases.PEER_MODELS[method], []).append(method)
    plan = speed_accuracy_cases.runs(lambda model: fit.get(model, []), options.repeats, options.whole)
    if options.only:
        plan = [run for run in plan if re.search(options.only, run.key)]
    if not plan:
        sys.exit("study: no run matches --only " + (options.only or ""))
    return plan


def is_finished(folder):
    exit_code = folder / "exit"
    return exit_code.is_file() and exit_code.read_text().strip() in FINISHED


def command_of(run, simulate, peer, seconds, at_commit):
    """One line of shell, to be run in the work folder. What is written last is the exit code; a run
    that was killed has none."""
    folder = f"runs/{run.key}"
    is_peer = run.method in speed_accuracy_cases.PEER_MODELS
    tolerance = speed_accuracy_cases.PEER_EXACT if is_peer and run.tolerance is None else run.tolerance
    solve = [str(peer if is_peer else simulate), f"scenes/{run.scene_key}.yaml", "--out", folder,
             "--method", run.method, "--quiet"]
    if tolerance is not None:
        solve += ["--tolerance", f"{tolerance:g}"]
    keep = "gzip -f nodes.csv" if run.repeat == 1 else "rm -f nodes.csv"
    return (f"rm -rf {folder} && mkdir -p {folder} && "
            f"{{ timeout {seconds:g} {' '.join(map(shlex.quote, solve))} 2>{folder}/stderr; c=$?; }}; "
            f"cd {folder} && echo {at_commit} >commit && "
            "grep -m1 '^model name' /proc/cpuinfo >machine; rm -f surface.stl; "
            f"if [ -f nodes.csv ]; then {keep}; fi; "
            f"case $c in [0-3]|{TIMED_OUT}) echo $c >exit;; *) exit $c;; esac")


def write_scenes(plan, work):
    (work / "scenes").mkdir(parents=True, exist_ok=True)
    (work / "runs").mkdir(exist_ok=True)
    for run in plan:
        file = work / "scenes" / f"{run.scene_key}.yaml"
        text = yaml.safe_dump(run.scene)
        if not file.is_file() or file.read_text() != text:
            file.write_text(text)


def lock(work):
    """A file that is locked until this process and all that it started have ended: a run that
    outlives a killed study is finished, or killed too, before another study looks at it."""
    file = open(work / "lock", "w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print("study: waiting for what runs in this folder", file=sys.stderr, flush=True)
        fcntl.flock(file, fcntl.LOCK_EX)
    return file


def end_with_parent():
    """Linux: killed with what started it, so that a killed study starts nothing more."""
    parent_death_signal = 1
    ctypes.CDLL(None).prctl(parent_death_signal, signal.SIGKILL)


def wait_for(parallel):
    """Exit code; stopped by the user, parallel ends its jobs before this ends."""
    try:
        return parallel.wait()
    except KeyboardInterrupt:
        for _ in range(2):  # the first asks it to start no more, the second to end what runs
            parallel.terminate()
        parallel.wait()
        sys.exit("study: stopped; start again to go on")


def run_all(plan, simulate, peer, options):
    if shutil.which("parallel") is None:
        sys.exit("study: GNU parallel is missing; Debian: apt-get install parallel")
    work = options.folder
    work.mkdir(parents=True, exist_ok=True)
    locked = lock(work)
    if options.again:
        for run in plan:
            shutil.rmtree(work / "runs" / run.key, ignore_errors=True)
    write_scenes(plan, work)
    todo = [run for run in plan if not is_finished(work / "runs" / run.key)]
    print(f"{len(plan)} runs, {len(plan) - len(todo)} finished, {len(todo)} to go", flush=True)
    lines = [command_of(run, simulate, peer, options.timeout, commit()) for run in todo]
    (work / "commands").write_text("".join(line + "\n" for line in lines))
    if options.list or not todo:
        return
    # Three columns: command, scene to send, folder to bring back.
    (work / "jobs").write_text("".join(f"{line}\tscenes/{run.scene_key}.yaml\truns/{run.key}\n"
                                       for line, run in zip(lines, todo)))
    command = ["parallel", "--will-cite", "--colsep", "\t", "--arg-file", "jobs", "--jobs",
               str(options.jobs), "--joblog", "+joblog"]
    if sys.stderr.isatty() and not options.quiet:
        command.append("--bar")
    if options.sshlogin:
        command += ["--sshlogin", options.sshlogin, "--transferfile", "{2}", "--return", "{3}",
                    "--cleanup", "--workdir", "..."]
    code = wait_for(subprocess.Popen([*command, "eval {1}"], cwd=work, stdin=subprocess.DEVNULL,
                                     pass_fds=[locked.fileno()], preexec_fn=end_with_parent))
    left = sum(not is_finished(work / "runs" / run.key) for run in todo)
    if left:
        print(f"study: {left} runs are not finished (parallel's exit code {code}); "
              "start again to go on", file=sys.stderr)


def displacements(folder):
    file = folder / "nodes.csv.gz"
    return np.loadtxt(file, delimiter=",", skiprows=1)[:, 3:] if file.is_file() else None


class Collector:
    """Rows of the table from the runs' folders."""

    def __init__(self, plan, work, compiler):
        self.plan, self.work, self.compiler = plan, work, compiler
        self.references = {f"{row['case']}/{float(row['poisson_ratio']):g}": row
                           for row in rows_of(accuracy.REFERENCE / "cases.csv")}
        self.exact = {}   # by lattice, the displacements of its equilibrium
        self.errors = {}  # by run without repeat, what its shape misses

    def folder_of(self, run):
        return self.work / "runs" / run.key

    def exact_of(self, run):
        """The exact equilibrium of the same lattice and model, None where there is none."""
        if run.lattice() not in self.exact:
            others = [other for other in self.plan
                      if other.lattice() == run.lattice() and other.tolerance is None]
            found = None
            for other in others:
                folder = self.folder_of(other)
                if is_finished(folder) and (folder / "exit").read_text().strip() == "0":
                    found = displacements(folder)
            self.exact[run.lattice()] = found
        return self.exact[run.lattice()]

    def reference_of(self, run):
        """Of the finite elements; lattices of springs alone are held against those of 0.25."""
        nu = 0.25 if run.nu is None else run.nu
        return self.references.get(f"{run.case}/{nu:g}")

    def errors_of(self, run):
        """Relative L2 of displacements: to the equilibrium of the lattice, to finite elements."""
        key = re.sub(r"_r\d+$", "", run.key)
        if key not in self.errors:
            moved = displacements(self.work / "runs" / (key + "_r1"))
            found = {"solver_error": "", "field_error": ""}
            exact, reference = self.exact_of(run), self.reference_of(run)
            if moved is not None and exact is not None:
                error = np.linalg.norm(moved - exact) / np.linalg.norm(exact)
                found["solver_error"] = f"{error:.4g}"
            if moved is not None and reference is not None:
                table = np.hstack([np.zeros_like(moved), moved])
                error = accuracy.field_error(reference, table, run.spacing)
                found["field_error"] = f"{error:.4g}"
            self.errors[key] = found
        return self.errors[key]

    def force_of(self, run, folder):
        """Norm of the last force: of the first patch, else of the first tool (N)."""
        for name in ("patches.csv", "tools.csv"):
            rows = rows_of(folder / name)
            if rows:
                return np.linalg.norm([float(rows[-1][key]) for key in ("fx", "fy", "fz")])
        return None

    def solved(self, run, folder):
        """Columns of a run that wrote its files."""
        rows = rows_of(folder / "increments.csv")
        # Rows in which nothing was solved, as those of tools that touch nothing, have no time.
        times = [float(row["wall_ms"]) for row in rows if float(row["wall_ms"]) > 0.0]
        force, reference = self.force_of(run, folder), self.reference_of(run)
        found = {"status": max((row["status"] for row in rows), key=WORST_LAST.index),
                 "increments": len(rows), **self.errors_of(run)}
        if times:
            found.update(ms_median=f"{statistics.median(times):.4g}", ms_min=f"{min(times):.4g}",
                         ms_max=f"{max(times):.4g}", ms_first=f"{times[0]:.4g}")
        if force is not None:
            found["force_n"] = f"{force:.6g}"
            if reference is not None:
                found["force_error"] = f"{force / float(reference['force_n']) - 1.0:.4g}"
        return found

    def row(self, run):
        folder = self.folder_of(run)
        code = int((folder / "exit").read_text())
        row = {"method": run.method, "model": run.model, "spacing_m": f"{run.spacing:g}",
               "nodes": nodes_of(run), "case": run.case, "repeat": run.repeat,
               "tolerance": "" if run.tolerance is None else f"{run.tolerance:g}",
               "poisson_ratio": "" if run.nu is None else f"{run.nu:g}",
               "commit": (folder / "commit").read_text().strip(),
               "machine": (folder / "machine").read_text().split(":", 1)[-1].strip(),
               "compiler": self.compiler}
        if code in (0, 3):
            return {**row, **self.solved(run, folder)}
        return {**row, "status": {1: "FAILED", 2: "REFUSED", TIMED_OUT: "TIMED_OUT"}[code]}

    def rows(self):
        return [self.row(run) for run in self.plan if is_finished(self.folder_of(run))]


def nodes_of(run):
    extent = np.subtract(run.scene["tissue"]["shape"]["max"], run.scene["tissue"]["shape"]["min"])
    return int(np.prod(np.rint(extent / run.spacing) + 1))


def add_arguments(parser):
    parser.add_argument("--simulate", help="the offline runner; default: the checkout's build")
    parser.add_argument("--methods", help="comma-separated; default: all there are")
    parser.add_argument("--only", metavar="REGEX", help="only runs whose key it is found in")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of each run (3)")
    parser.add_argument("--whole", action="store_true",
                        help="also what takes long: hours, most of it newton at 2.5 mm")
    parser.add_argument("--timeout", type=float, default=300.0, metavar="S", help="of a run (300)")
    parser.add_argument("--jobs", type=int, default=1, help="at a time, on each machine (1)")
    parser.add_argument("--sshlogin", help="machines, as GNU parallel takes them")
    parser.add_argument("--folder", type=Path, default=PACKAGE / "build/study",
                        help="where scenes and results are kept (build/study)")
    parser.add_argument("--table", type=Path, default=TABLE, help="what is collected")
    parser.add_argument("--list", action="store_true", help="only write FOLDER/commands")
    parser.add_argument("--collect", action="store_true", help="run nothing, collect what there is")
    parser.add_argument("--again", action="store_true", help="drop finished runs first")
    parser.add_argument("--plot", action="store_true", help="only draw from the table")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(options):
    if options.repeats < 1 or options.jobs < 1 or not options.timeout > 0.0:
        sys.exit("study: --repeats and --jobs must be at least 1, --timeout > 0")
    options.folder = options.folder.resolve()
    if options.plot:
        speed_accuracy_charts.draw(options.table)
        return
    simulate = Path(options.simulate).resolve() if options.simulate else program("simulate")
    peer = simulate.parent / "bullet_peer"
    plan = planned(simulate, peer, options)
    if not options.collect:
        run_all(plan, simulate, peer, options)
    if options.list:
        print(f"wrote {options.folder / 'commands'}")
        return
    rows = Collector(plan, options.folder, compiler_of(simulate)).rows()
    write_rows(options.table, COLUMNS, rows)
    print(f"{len(rows)} rows in {options.table}")
