#!/usr/bin/python3
"""package.xml names keys that rosdep has, and the scripts install what these keys stand for.
"""
import csv
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import rosunit

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent


def lines_of(path):
    return [line for line in path.read_text().splitlines() if line and not line.startswith("#")]


def table():
    return list(csv.DictReader(lines_of(HERE / "rosdep_keys.csv")))


def package_keys():
    root = ElementTree.parse(SOURCE / "package.xml").getroot()
    return {entry.text for entry in root if entry.tag.endswith("depend")}


def packages_of(rows):
    return [package for row in rows for package in row["debian_packages"].split()]


class Dependencies(unittest.TestCase):
    def test_keys_are_those_of_rosdep(self):
        known = [row["key"] for row in table() if row["key"]]
        self.assertEqual(sorted(package_keys()), sorted(known))

    def test_scripts_install_what_the_keys_stand_for(self):
        installed = lines_of(SOURCE / "scripts/debian_packages")
        self.assertEqual(installed, sorted(set(installed)))
        self.assertEqual(installed, sorted(set(packages_of(table()))))

    def test_studies_and_nightly_do_not_burden_the_users_of_the_node(self):
        for name in ("study_packages", "nightly_packages"):
            packages = lines_of(SOURCE / "scripts" / name)
            self.assertEqual(packages, sorted(set(packages)))
            self.assertFalse(set(packages) & set(packages_of(table())))

    def test_package_says_who_and_where(self):
        root = ElementTree.parse(SOURCE / "package.xml").getroot()
        for tag in ("author", "maintainer", "license", "url"):
            self.assertTrue(root.findtext(tag), tag)

    @unittest.skipUnless(shutil.which("catkin_lint"), "a ROS from elsewhere has none")
    def test_catkin_lint_finds_nothing(self):
        lint = subprocess.run(["catkin_lint", "--offline", "--rosdistro", "noetic", str(SOURCE)],
                              capture_output=True, text=True)
        self.assertEqual(lint.returncode, 0, lint.stdout + lint.stderr)
        self.assertIn("checked 1 packages and found 0 problems", lint.stdout + lint.stderr)


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "dependencies", Dependencies, sys.argv)
