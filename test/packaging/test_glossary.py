#!/usr/bin/python3
"""The code speaks the words of doc/architecture.md, the field's: none is missing in it, none that they
took the place of is back. Nothing that was there to look for an error is left in it.
"""
import re
import sys
import unittest
from pathlib import Path

import rosunit

SOURCE = Path(__file__).resolve().parent.parent.parent
PAGE = SOURCE / "doc/architecture.md"
FOLDERS = ("config", "include", "launch", "msg", "scripts", "src", "srv", "test")
SUFFIXES = {".cfg", ".cmake", ".cpp", ".h", ".launch", ".msg", ".py", ".srv", ".test", ".txt", ".yaml", ""}
HERE = Path(__file__).resolve()


def files_in(folders):
    return [path for folder in folders for path in sorted((SOURCE / folder).rglob("*"))
            if path.is_file() and path.suffix in SUFFIXES and path != HERE]


def names_in(text):
    return set(re.findall(r"[A-Za-z_]\w*", text))


def section(title):
    return re.split(r"^## ", PAGE.read_text().split(f"## {title}\n")[1], flags=re.MULTILINE)[0]


def rows_under(heading, text):
    """Cells of the table whose first heading this is."""
    table = re.search(rf"^\| {heading} \|.*\n\|[-|]+\n((?:\|.*\n)+)", text, re.MULTILINE).group(1)
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()]


def quoted(text):
    return re.findall(r"`([^`\n]+)`", text)


def retired():
    return {name for row in rows_under("retired", section("Words")) for name in quoted(row[0])}


def spoken(text):
    """`Woodbury update`, woodbury_update and WoodburyUpdate are the same two words."""
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", text)
    return " ".join(re.findall(r"[a-z]+", parted.lower()))


class Glossary(unittest.TestCase):
    def test_words_are_those_of_the_code(self):
        code = f' {spoken(chr(10).join(path.read_text() for path in files_in(("include", "src"))))} '
        rows = rows_under("word", section("Words"))
        self.assertGreater(len(rows), 20)
        for word, *_ in rows:
            ways = [spoken(way.lower()) for way in re.split(r", | \(|\)", word) if way]
            found = [way for way in ways if re.search(f" {way}(s|es)? ", code)]
            self.assertTrue(found, word)

    def test_retired_names_stay_away(self):
        names = retired()
        self.assertGreater(len(names), 20)
        for path in files_in(FOLDERS):
            if path.suffix == "" and path.parent.name != "scripts":
                continue
            found = names & (names_in(path.read_text()) | names_in(path.name))
            self.assertFalse(found, f"{path.relative_to(SOURCE)}: see doc/architecture.md, \"Words\"")

    def test_names_on_the_page_are_there(self):
        texts = [path.read_text() for path in files_in(FOLDERS) if path.suffix]
        paths = [str(path.relative_to(SOURCE)) for path in files_in((*FOLDERS, "doc"))]
        there = names_in("\n".join([*texts, *paths, (SOURCE / "CMakeLists.txt").read_text()]))
        camel = {name for code in quoted(PAGE.read_text()) for name in names_in(code)
                 if re.fullmatch(r"[A-Za-z]+[a-z][A-Z]\w*", name)}
        self.assertGreater(len(camel), 50)
        self.assertEqual(sorted(camel - there - retired()), [])

    def test_no_switch_or_print_is_left_in_the_libraries(self):
        folders = [f"src/{name}" for name in ("core", "contact", "coupling", "mesh", "pipeline")]
        paths = files_in((*folders, "include"))
        self.assertGreater(len(paths), 100)
        for path in paths:
            found = {"getenv", "printf", "fprintf", "cerr", "cout"} & names_in(path.read_text())
            self.assertFalse(found, path.relative_to(SOURCE))


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "glossary", Glossary, sys.argv)
