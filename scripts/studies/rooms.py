"""Draws the package as it is built, now and before core had rooms: what uses what, and how much it is.

Read from src/core/rooms.cmake and CMakeLists.txt, whose lists the build checks; lines of code are
those of the folders and of their public headers. Only uses that follow from no other are drawn. The
tree of before is taken from git, where this is a checkout. Prints of both the lines and the number
of public headers of each part, the largest files and functions, and the classes with the most
private methods, as Universal Ctags finds them. Writes doc/images/rooms.png and rooms_before.png.
"""

import collections
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from studies.common import IMAGES, PACKAGE, pyplot

BEFORE = "370e619"  # the last commit in which core is one folder
ROOM = re.compile(r"^robot_tissue_room\(([^)]*)\)", re.MULTILINE)
LAYER = re.compile(r"^robot_tissue_layer\((\w+)(?: USES ([\w ]+))?\)", re.MULTILINE)
KEYWORDS = ("USES", "PUBLIC", "FILES", "VECTOR_LOOPS")
CORE, ABOVE = "#dbe7f3", "#f3e6d3"
MOST = 3  # files, functions and classes that are printed


def lists_of(words):
    """The words of a call of robot_tissue_room: its name, and a list a keyword."""
    lists, keyword = {word: [] for word in KEYWORDS}, None
    for word in words[1:]:
        if word in KEYWORDS:
            keyword = word
        else:
            lists[keyword].append(word)
    return words[0], lists


def line_count(paths):
    return sum(len(path.read_text().splitlines()) for path in paths)


def sources_below(folder):
    return [path for path in folder.rglob("*") if path.suffix in (".h", ".cpp")]


def rooms_of(tree):
    """Name: uses, lines, public headers, color; none where core is one folder."""
    table = tree / "src/core/rooms.cmake"
    found = {}
    for call in ROOM.findall(table.read_text()) if table.exists() else []:
        name, lists = lists_of(call.split())
        files = [tree / "src/core" / name / file for file in lists["FILES"] + lists["VECTOR_LOOPS"]]
        public = [tree / "include/robot_tissue/core" / file for file in lists["PUBLIC"]]
        found[name] = (lists["USES"], line_count(files + public), len(public), CORE)
    return found


def parts(tree):
    """Name: what it uses, lines, public headers, color; from the lowest up."""
    found = rooms_of(tree)
    rooms = list(found)
    for name, uses in LAYER.findall((tree / "CMakeLists.txt").read_text()):
        if name == "core" and rooms:
            continue
        public = sources_below(tree / "include/robot_tissue" / name)
        lines = line_count(public + sources_below(tree / "src" / name))
        below = [used for word in uses.split()
                 for used in (rooms[-1:] if word == "core" and rooms else [word])]
        found[name] = (below, lines, len(public), CORE if name == "core" else ABOVE)
    return found


def reached(name, found):
    all_used = set()
    for used in found[name][0]:
        all_used |= {used} | reached(used, found)
    return all_used


def direct(name, found):
    """Uses that follow from no other."""
    uses = set(found[name][0])
    return {used for used in uses
            if not any(used in reached(other, found) for other in uses - {used})}


def heights(found):
    high = {}
    for name in found:
        high[name] = 1 + max((high[used] for used in found[name][0]), default=-1)
    return high


def places(found):
    """Name: x, y; in a row by the mean place of what is used."""
    high, place = heights(found), {}
    for level in range(1 + max(high.values())):
        row = [name for name in found if high[name] == level]
        middle = {name: sum(place[used][0] for used in direct(name, found)) /
                  max(1, len(direct(name, found))) for name in row}
        row.sort(key=lambda name: (middle[name], "multigrid" in name))
        for index, name in enumerate(row):
            place[name] = (index - 0.5 * (len(row) - 1), level)
    return place


def draw(found, title, plot):
    place = places(found)
    rows = {y for _, y in place.values()}
    widest = max(x for x, _ in place.values()) + 0.7
    figure, axes = pyplot().subplots(figsize=(max(6.0, 4.1 * widest), 1.1 * (len(rows) + 1)))
    for name, (_, lines, headers, color) in found.items():
        x, y = place[name]
        for used in direct(name, found):
            low_x, low_y = place[used]
            axes.annotate("", (low_x, low_y + 0.18), (x, y - 0.18), zorder=1,
                          arrowprops={"arrowstyle": "->", "color": "0.6", "linewidth": 0.9})
        seen = f", {headers} public headers" if name == "core" else ""
        axes.text(x, y, f"{name.replace('solvers/', '')}\n{lines:,} lines{seen}", ha="center",
                  va="center", fontsize=8.5, zorder=2,
                  bbox={"boxstyle": "round,pad=0.35", "facecolor": color, "edgecolor": "0.5"})
    axes.set_xlim(-widest, widest)
    axes.set_ylim(-0.6, len(rows) - 0.4)
    axes.axis("off")
    axes.set_title(title)
    figure.tight_layout()
    plot.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(plot, dpi=110)


def tags_of(tree):
    """Functions and methods in src and include: name, file, and the fields of Universal Ctags."""
    command = ["ctags", "-R", "--languages=C++", "--langmap=C++:+.h", "--kinds-C++=fp",
               "--fields=+nea", "-f", "-", "src", "include"]
    try:
        output = subprocess.run(command, cwd=tree, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"study: no Universal Ctags ({error}); Debian: universal-ctags")
    for line in output.splitlines():
        name, file, _, *fields = line.split("\t")
        if file.startswith(("src", "include")):
            yield name, file, dict(field.split(":", 1) for field in fields if ":" in field)


def print_largest(tree, found):
    sources = sources_below(tree / "src") + sources_below(tree / "include")
    files = sorted(((line_count([path]), str(path.relative_to(tree))) for path in sources),
                   reverse=True)
    functions, private = [], collections.Counter()
    for name, file, fields in tags_of(tree):
        owner = fields.get("class", fields.get("struct", "")).split("::")[-1]
        if "end" in fields:
            functions.append((int(fields["end"]) - int(fields["line"]) + 1, f"{name} ({file})"))
        if fields.get("access") == "private" and owner:
            private[owner] += 1
    headers = sum(found[name][2] for name in found if found[name][3] == CORE)
    print(f"public headers of core: {headers}")
    print("longest files:", ", ".join(f"{lines} {name}" for lines, name in files[:MOST]))
    longest = sorted(functions, reverse=True)[:MOST]
    print("longest functions:", ", ".join(f"{lines} {name}" for lines, name in longest))
    print("most private methods:",
          ", ".join(f"{count} {name}" for name, count in private.most_common(MOST)))


def show(tree, title, plot):
    print(title)
    found = parts(tree)
    for name, (uses, lines, public, _) in found.items():
        print(f"{name:<32} {lines:>6} lines {public:>3} public headers  uses {' '.join(uses) or '-'}")
    print_largest(tree, found)
    draw(found, title, plot)


def tree_of(revision, folder):
    """Writes the tree of a git revision there. False: this is no checkout that has it."""
    archive = subprocess.run(["git", "archive", revision], cwd=PACKAGE, capture_output=True)
    if archive.returncode == 0:
        subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
    return archive.returncode == 0


def add_arguments(parser):
    parser.add_argument("--before", default=BEFORE, metavar="REVISION",
                        help="the git revision of rooms_before.png; default: %(default)s")
    parser.add_argument("--plot", action="store_true", help="it never measures anything")


def run(options):
    with tempfile.TemporaryDirectory() as folder:
        if tree_of(options.before, folder):
            show(Path(folder), f"Before ({options.before}): core and layers, above what they use",
                 IMAGES / "rooms_before.png")
        else:
            print(f"no git checkout with the revision {options.before}: nothing of before is drawn")
    print()
    show(PACKAGE, "Rooms of core (blue) and layers (sand), above what they use",
         IMAGES / "rooms.png")
