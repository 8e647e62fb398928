"""Draws the package as it is built: the rooms of core, the layers above them, and what each uses.

Read from src/core/rooms.cmake and CMakeLists.txt, whose lists the build checks; lines of code are
those of the folders and of their public headers. Only uses that follow from no other are drawn.
Writes doc/images/rooms.png; prints the lines and the number of headers of each.
"""

import re

from studies.common import IMAGES, PACKAGE, add_plot, pyplot

PLOT = IMAGES / "rooms.png"
ROOM = re.compile(r"^robot_tissue_room\(([^)]*)\)", re.MULTILINE)
LAYER = re.compile(r"^robot_tissue_layer\((\w+)(?: USES ([\w ]+))?\)", re.MULTILINE)
KEYWORDS = ("USES", "PUBLIC", "FILES", "VECTOR_LOOPS")
CORE, ABOVE = "#dbe7f3", "#f3e6d3"


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


def parts():
    """Name: what it uses, lines, public headers, color; from the lowest up."""
    found = {}
    include = PACKAGE / "include/robot_tissue"
    for call in ROOM.findall((PACKAGE / "src/core/rooms.cmake").read_text()):
        name, lists = lists_of(call.split())
        files = [PACKAGE / "src/core" / name / file
                 for file in lists["FILES"] + lists["VECTOR_LOOPS"]]
        public = [include / "core" / file for file in lists["PUBLIC"]]
        found[name] = (lists["USES"], line_count(files + public), len(public), CORE)
    rooms = list(found)
    for name, uses in LAYER.findall((PACKAGE / "CMakeLists.txt").read_text()):
        if name == "core":
            continue
        public = sources_below(include / name)
        lines = line_count(public + sources_below(PACKAGE / "src" / name))
        below = [used for word in uses.split() for used in (rooms[-1:] if word == "core" else [word])]
        found[name] = (below, lines, len(public), ABOVE)
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


def draw(found):
    place = places(found)
    rows = {y for _, y in place.values()}
    figure, axes = pyplot().subplots(figsize=(11, 1.1 * (len(rows) + 1)))
    for name, (_, lines, _, color) in found.items():
        x, y = place[name]
        for used in direct(name, found):
            low_x, low_y = place[used]
            axes.annotate("", (low_x, low_y + 0.18), (x, y - 0.18), zorder=1,
                          arrowprops={"arrowstyle": "->", "color": "0.6", "linewidth": 0.9})
        axes.text(x, y, f"{name.replace('solvers/', '')}\n{lines:,} lines", ha="center", va="center",
                  fontsize=8.5, zorder=2,
                  bbox={"boxstyle": "round,pad=0.35", "facecolor": color, "edgecolor": "0.5"})
    widest = max(x for x, _ in place.values()) + 0.7
    axes.set_xlim(-widest, widest)
    axes.set_ylim(-0.6, len(rows) - 0.4)
    axes.axis("off")
    axes.set_title("Rooms of core (blue) and layers (sand), above what they use")
    figure.tight_layout()
    PLOT.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PLOT, dpi=110)


def add_arguments(parser):
    add_plot(parser)


def run(_):
    found = parts()
    for name, (uses, lines, public, _) in found.items():
        print(f"{name:<32} {lines:>6} lines {public:>3} public headers  uses {' '.join(uses) or '-'}")
    draw(found)
