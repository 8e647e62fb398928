#!/usr/bin/python3
"""The scripts tell what they do without a master, a build or a network."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

import rosunit

SCRIPTS = Path(__file__).resolve().parent.parent.parent / "scripts"
HELPERS = ("admittance", "count_tests", "demo", "demo_player", "nightly", "play", "test")
DEADLINE = 60  # s; reached only by what waits for a master, or builds
NO_MASTER = {"ROS_MASTER_URI": "http://localhost:1"}


class Helpers(unittest.TestCase):
    def test_help_is_told_at_once(self):
        for helper in HELPERS:
            for flag in "--help", "-h":
                run = subprocess.run([SCRIPTS / helper, flag], capture_output=True, text=True, timeout=DEADLINE,
                                     env={**os.environ, **NO_MASTER})
                self.assertEqual(run.returncode, 0, (helper, run.stderr))
                self.assertGreater(len(run.stdout.split()), 5, helper)
                self.assertEqual(run.stderr, "", helper)


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "helpers", Helpers, sysargs=sys.argv)
