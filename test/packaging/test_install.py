#!/usr/bin/python3
"""What is installed is complete: the demo runs from it, another package builds and runs with it.

usage: test_install.py BUILD_DIR [--gtest_output=xml:FILE], configured to install within BUILD_DIR.
"""
import filecmp
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import unittest
from pathlib import Path

import rosunit

SOURCE = Path(__file__).resolve().parent.parent.parent
BUILD = Path(sys.argv[1]).resolve()
WORK = BUILD / "install_test"
LONGEST = 300  # s, of one command; reached only when something is wrong


def prefix():
    cache = (BUILD / "CMakeCache.txt").read_text()
    return Path(re.search(r"^CMAKE_INSTALL_PREFIX:\w+=(.*)$", cache, re.MULTILINE).group(1))


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


# Nothing of the build directory's environment, in which everything would be found.
ENVIRONMENT = {"HOME": str(WORK), "PATH": "/usr/bin:/bin", "ROS_HOSTNAME": "localhost",
               "ROS_MASTER_URI": f"http://localhost:{free_port()}", "LC_ALL": "C.UTF-8"}


def start(command, space=None):
    setup = (space or prefix()) / "setup.bash"
    return subprocess.Popen(["bash", "-c", f"source '{setup}' && exec {command}"],
                            cwd=WORK, env=ENVIRONMENT, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, start_new_session=True)


def output_of(command, space=None):
    process = start(command, space)
    try:
        output, _ = process.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
    assert process.returncode == 0, f"{command}: exit code {process.returncode}\n{output}"
    return output


def files_in(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


class InstallSpace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(prefix(), ignore_errors=True)
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir()
        subprocess.run(["cmake", "--install", BUILD], check=True, stdout=subprocess.DEVNULL)
        cls.share = prefix() / "share/robot_tissue"
        cls.programs = prefix() / "lib/robot_tissue"

    # roslaunch looks for files in all folders below a package, and refuses what it finds twice.
    def test_the_checkout_still_has_each_launch_file_once(self):
        found = output_of("roslaunch --files robot_tissue demo.launch", BUILD / "devel")
        self.assertIn(str(SOURCE / "launch/demo.launch"), found)

    def test_all_files_are_there(self):
        for folder in ("launch", "config", "msg", "srv"):
            self.assertEqual(files_in(self.share / folder), files_in(SOURCE / folder))
        self.assertTrue(filecmp.cmp(self.share / "package.xml", SOURCE / "package.xml", False))
        headers = set(files_in(prefix() / "include/robot_tissue"))
        self.assertLessEqual(set(files_in(SOURCE / "include/robot_tissue")), headers)
        for program in ("robot_tissue_node", "simulate", "fidelity", "check_setup", "replay",
                        "admittance", "demo_player", "play"):
            self.assertTrue(os.access(self.programs / program, os.X_OK), program)
        self.assertTrue((self.programs / "play_markers.py").is_file())
        self.assertEqual(output_of("rospack find robot_tissue").strip(), str(self.share))

    def test_only_programs_of_the_command_line_carry_cholmod(self):
        libraries = [path for path in (prefix() / "lib").glob("librobot_tissue_*")
                     if path.name != "librobot_tissue_cholmod.so"]
        self.assertGreater(len(libraries), 4)
        for file in [self.programs / "robot_tissue_node", *libraries]:
            needed = output_of(f"ldd '{file}'")
            self.assertNotIn("cholmod", needed, file)
            self.assertNotIn("not found", needed, file)
            self.assertNotIn(f"{BUILD}/devel", needed, file)

    def test_headers_compile(self):
        headers = files_in(SOURCE / "include")
        (WORK / "headers.cpp").write_text("".join(f"#include <{header}>\n" for header in headers))
        folders = output_of("printenv CMAKE_PREFIX_PATH").strip().split(":") + ["/usr"]
        includes = " ".join(f"-isystem '{folder}/include'" for folder in folders
                            if folder != "/usr" and Path(folder, "include").is_dir())
        output_of(f"c++ -std=c++17 -fsyntax-only {includes} $(pkg-config --cflags eigen3) "
                  "headers.cpp")

    def test_simulate_runs(self):
        scene = self.share / "config/probe_scene.yaml"
        output_of(f"rosrun robot_tissue simulate '{scene}' --out probe")
        self.assertTrue((WORK / "probe/tools.csv").is_file())

    def test_a_package_builds_with_it_and_follows_the_demo(self):
        downstream = SOURCE / "test/downstream"
        output_of(f"cmake -S '{downstream}' -B downstream")
        output_of("cmake --build downstream -- -j2")
        programs = WORK / "downstream/devel/lib/robot_tissue_downstream"
        self.assertIn("patch -", output_of(f"'{programs}/press'"))
        demo = start("roslaunch robot_tissue demo.launch headless:=true")
        calls = re.findall(r"^rosservice call .*?'$", (SOURCE / "doc/node.md").read_text(),
                           re.MULTILINE | re.DOTALL)
        try:
            followed = output_of(f"'{programs}/follow_demo'")
            answers = [output_of(call) for call in calls if "/cut" in call or "punch" in call]
            diagnostics = output_of("rostopic echo -n 1 /diagnostics")
        finally:
            demo.send_signal(signal.SIGINT)
            log, _ = demo.communicate(timeout=LONGEST)
            print(log)  # shown beside what fails
        self.assertIn("reset 1", followed)
        self.assertEqual(["success:" in answer for answer in answers], [True, True], answers)
        self.assertIn("robot_tissue: solver", diagnostics)
        self.assertEqual(demo.returncode, 0, log)
        self.assertNotIn(str(BUILD / "devel"), log)


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "install", InstallSpace, [sys.argv[0], *sys.argv[2:]])
