"""What the studies share: places, tables, programs, pictures, progress."""

import csv
import gzip
import io
import re
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent.parent
DATA = PACKAGE / "doc/data"
IMAGES = PACKAGE / "doc/images"
# Of the checkout itself, and of a catkin workspace around it.
BUILDS = ["build/devel/lib/robot_tissue", "../../devel/lib/robot_tissue"]
WORST_LAST = ["OK", "LATE", "UNCONVERGED", "INVERTED"]  # status of an increment


def rows_of(path):
    """Of a CSV file, also a packed one; none where there is no file."""
    if not path.exists():
        return []
    opener = gzip.open if path.suffix == ".gz" else open
    with opener(path, "rt", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write_rows(path, columns, rows, head=""):
    """As a whole or not at all, and the same bytes for the same rows. `head`: lines before."""
    text = io.StringIO()
    text.write(head)
    table = csv.DictWriter(text, columns, lineterminator="\n", restval="")
    table.writeheader()
    table.writerows(rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    data = text.getvalue().encode()
    part.write_bytes(gzip.compress(data, mtime=0) if path.suffix == ".gz" else data)
    part.replace(path)


def print_rows(rows):
    """A line each, of what is known."""
    for row in rows:
        print(", ".join(f"{key} {value}" for key, value in row.items() if value))


def numbers(rows, column):
    return [float(row[column]) for row in rows]


def percentile(values, percent):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(percent / 100.0 * len(ordered)))]


def worst(rows):
    return max((row["status"] for row in rows), key=WORST_LAST.index)


def add_programs(parser):
    parser.add_argument("--programs", type=Path, metavar="FOLDER",
                        help="where the built programs are; default: the checkout's build")


def add_plot(parser):
    parser.add_argument("--plot", action="store_true", help="measure nothing: draw and print only")


def program(name, folder=None):
    """A built program, in the folder or where the checkout builds."""
    folders = [folder] if folder else [PACKAGE / build for build in BUILDS]
    for place in folders:
        if (place / name).is_file():
            refuse_stale(place / name)
            return (place / name).resolve()
    sys.exit(f"study: no program {name} in " + ", ".join(map(str, folders)) +
             f"; build it (target {name}) first, or give --programs FOLDER")


def refuse_stale(program):
    """A program that is older than a library that it needs has another idea of what its classes hold."""
    needed = program.read_bytes()  # of these it holds the names
    newer = [library.name for library in program.parent.parent.glob("librobot_tissue_*.so")
             if library.name.encode() in needed and library.stat().st_mtime > program.stat().st_mtime]
    if newer:
        sys.exit(f"study: {program} is older than {newer[0]}; build it anew (target {program.name})")


def pyplot():
    """Where there is no screen, too; loaded only by what draws."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot
    return matplotlib.pyplot


def progress(jobs, name_of=str):
    """The jobs, one after the other; tells on a terminal which one is under way."""
    jobs = list(jobs)
    for done, job in enumerate(jobs, start=1):
        if sys.stderr.isatty():
            print(f"\r\033[K{done}/{len(jobs)} {name_of(job)}", end="", file=sys.stderr, flush=True)
        yield job
    if jobs and sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr, flush=True)


def first_match(pattern, text):
    found = re.search(pattern, text, re.MULTILINE)
    return found.group(1).strip() if found else "unknown"


def compiler_of(built):
    return first_match(r"(GCC: \([^)]*\) [0-9.]+|clang version [0-9.]+)",
                       Path(built).read_bytes().decode("latin-1"))


def commit():
    """The last commit, from git's own files."""
    try:
        head = (PACKAGE / ".git/HEAD").read_text().strip()
        if not head.startswith("ref: "):
            return head
        loose = PACKAGE / ".git" / head[5:]
        if loose.is_file():
            return loose.read_text().strip()
        packed = (PACKAGE / ".git/packed-refs").read_text()
        return first_match(rf"^([0-9a-f]+) {re.escape(head[5:])}$", packed)
    except OSError:
        return "unknown"
