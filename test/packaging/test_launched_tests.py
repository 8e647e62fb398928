#!/usr/bin/python3
"""Each test of the running node is started by one launch file: one that no filter names would be run by
nobody.
"""
import fnmatch
import re
import unittest
from pathlib import Path

import rosunit

ROS = Path(__file__).resolve().parent.parent / "ros"
SUITE = re.compile(r"^(?:TEST|TEST_F)\((\w+),|^INSTANTIATE_TEST_SUITE_P\(\s*(\w+), (\w+),", re.MULTILINE)


def suites():
    """Of the sources of node_tests: those without a launch file of their name are of other programs."""
    for source in sorted(ROS.glob("test_*.cpp")):
        if (ROS / source.name[len("test_"):]).with_suffix(".test").exists():
            for plain, instance, of in SUITE.findall(source.read_text()):
                yield plain or f"{instance}/{of}"


def filters():
    for launch in sorted(ROS.glob("*.test")):
        for of_launch in re.findall(r"--gtest_filter=([^\"]+)", launch.read_text()):
            yield launch.name, of_launch.split(":")


class LaunchedTests(unittest.TestCase):
    def test_every_suite_is_started_once(self):
        found = set(suites())
        self.assertGreater(len(found), 16)
        for suite in found:
            starts = [launch for launch, patterns in filters()
                      if any(fnmatch.fnmatchcase(f"{suite}.", pattern.rstrip("*")) for pattern in patterns)]
            self.assertEqual(len(starts), 1, f"{suite}: {starts}")


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "launched_tests", LaunchedTests)
