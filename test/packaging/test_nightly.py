#!/usr/bin/python3
"""scripts/nightly starts a part alone, and a part that fails is told by its exit code.
"""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosunit

NIGHTLY = Path(__file__).resolve().parent.parent.parent / "scripts/nightly"


def run(arguments, clang_format="exit 0"):
    """With a clang-format that does as told. A ROS that is sourced: nothing is installed."""
    with tempfile.TemporaryDirectory() as folder:
        stand_in = Path(folder) / "clang-format"
        stand_in.write_text(f"#!/bin/sh\n{clang_format}\n")
        stand_in.chmod(0o755)
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "ROS_DISTRO": "other",
                       "CMAKE_PREFIX_PATH": "/opt/ros/other"}
        return subprocess.run([NIGHTLY, *arguments], capture_output=True, text=True, env=environment)


class Nightly(unittest.TestCase):
    def test_part_is_started_alone(self):
        result = run(["format"])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        parts = [line for line in result.stdout.splitlines() if "ROS" not in line]
        self.assertEqual(parts, ["== format", "== format: fine"])

    def test_failed_part_is_told(self):
        result = run(["format"], "echo what is wrong; exit 1")
        self.assertEqual(result.returncode, 1)
        self.assertIn("== format: FAILED", result.stdout)
        self.assertIn("what is wrong", result.stdout)
        self.assertEqual(result.stderr, "nightly: format failed\n")

    def test_wrong_arguments_are_refused(self):
        for arguments in (["lunch"], ["--minutes"], ["--minutes", "-1"], ["--minutes", "x", "format"]):
            result = run(arguments)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "nightly", Nightly, sysargs=sys.argv)
