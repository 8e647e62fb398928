#!/usr/bin/python3
"""The documents are short where they have to be, and what they point to is there."""
import re
import sys
import unittest
from pathlib import Path

import rosunit

SOURCE = Path(__file__).resolve().parent.parent.parent
MOST_WORDS = 900  # of the README
LONGEST_LINE = 120  # characters, of prose in the documents that strangers read first
FIRST_READ = ("README.md", "doc/scene.md", "doc/runner.md", "doc/node.md", "doc/recipes.md",
              "doc/dependencies.md")


def documents():
    return [SOURCE / "README.md", *sorted((SOURCE / "doc").glob("*.md"))]


def without_code(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)


def links_of(document):
    """Targets of [text](target) and ![text](target) outside code."""
    text = re.sub(r"`[^`\n]*`", "", without_code(document.read_text()))
    return re.findall(r"\]\(([^)\s]+)\)", text)


def anchors_of(document):
    """As a forge makes them of headings: small letters, no marks, dashes for blanks."""
    headings = re.findall(r"^#+ +(.*)$", without_code(document.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in headings}


class Documents(unittest.TestCase):
    def test_readme_is_short(self):
        words = len((SOURCE / "README.md").read_text().split())
        self.assertLessEqual(words, MOST_WORDS)

    def test_links_lead_somewhere(self):
        for document in documents():
            for link in links_of(document):
                if re.match(r"[a-z]+:", link):
                    continue
                path, _, anchor = link.partition("#")
                target = (document.parent / path).resolve() if path else document
                self.assertTrue(target.exists(), f"{document.name}: {link}")
                self.assertTrue(target.is_relative_to(SOURCE), f"{document.name}: {link}")
                if anchor:
                    self.assertIn(anchor, anchors_of(target), f"{document.name}: {link}")

    def test_documents_are_reached_from_the_readme(self):
        reached, ahead = set(), [SOURCE / "README.md"]
        while ahead:
            document = ahead.pop()
            reached.add(document)
            targets = {(document.parent / link.partition("#")[0]).resolve()
                       for link in links_of(document) if not re.match(r"[a-z]+:|#", link)}
            ahead += [target for target in targets - reached if target.suffix == ".md"]
        self.assertEqual(sorted(set(documents()) - reached), [])

    def test_lines_of_prose_fit_a_screen(self):
        for name in FIRST_READ:
            for line in without_code((SOURCE / name).read_text()).splitlines():
                if not line.startswith("|"):
                    self.assertLessEqual(len(line), LONGEST_LINE, f"{name}: {line}")


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "documents", Documents, sys.argv)
