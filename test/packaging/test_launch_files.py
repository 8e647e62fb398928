#!/usr/bin/python3
"""What the launch files start, with which names and arguments: they are read as roslaunch reads them, and started
by other tests.
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import rosgraph.names
import roslaunch.config
import roslaunch.xmlloader
import rosunit
import yaml

ROOT = Path(__file__).resolve().parent.parent.parent
LAUNCH = ROOT / "launch"
SCENE = str(ROOT / "config/probe_scene.yaml")
MADE_UP = {"rate": "7.0", "wrench_rate": "3.0", "force_scale": "0.5", "tf_timeout": "0.25", "color": "strain",
           "robot_description_param": "arm_description", "state_dir": "/tmp/kept here"}


def loaded(file, arguments, namespace="/"):
    """Of a launch file that is included with these arguments in the namespace."""
    given = "".join(f'<arg name="{name}" value="{value}"/>' for name, value in arguments.items())
    text = f'<launch><group ns="{namespace}"><include file="{LAUNCH / file}">{given}</include></group></launch>'
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load_string(text, config, verbose=False)
    return config


def node(config, kind):
    found = [each for each in config.nodes if each.type == kind]
    assert len(found) == 1, (kind, [each.type for each in config.nodes])
    return found[0]


def parameter(config, name):
    return config.params[name].value


def placed(**arguments):
    return loaded("own_robot.launch", {"scene": SCENE, "rviz": "false", **arguments})


class LaunchFiles(unittest.TestCase):
    def test_in_a_namespace_rviz_shows_what_the_nodes_there_publish(self):
        for file, arguments, name in (("own_robot.launch", {"scene": SCENE, "name": "organ"}, "organ"),
                                      ("play.launch", {}, "robot_tissue"), ("demo.launch", {}, "robot_tissue")):
            for namespace in "/", "/left":
                rviz = node(loaded(file, arguments, namespace), "rviz")
                topics = {wanted: rosgraph.names.ns_join(rviz.namespace, shown)
                          for wanted, shown in rviz.remap_args}
                self.assertEqual(topics["/robot_tissue/markers"],
                                 rosgraph.names.ns_join(namespace, name) + "/markers", file)
                shown = ROOT / re.search(r"config/\w+\.rviz", rviz.args)[0]
                for topic in re.findall(r"Topic: (/.+)", shown.read_text()):
                    self.assertIn(topic, topics, file)

    def test_nothing_in_a_launch_file_leaves_its_namespace(self):
        for file in sorted(LAUNCH.glob("*.launch")):
            for element in ElementTree.parse(file).iter():
                for key in "name", "to", "ns":
                    self.assertFalse(element.get(key, "").startswith("/"), (file.name, element.attrib))

    def test_own_robot_hands_on_what_the_tissue_takes(self):
        names = {file: {arg.get("name") for arg in ElementTree.parse(LAUNCH / file).getroot().iter("arg")}
                 for file in ("own_robot.launch", "tissue.launch")}
        self.assertEqual(names["tissue.launch"] - names["own_robot.launch"], set())
        config = placed(description=str(ROOT / "config/demo_arm.urdf"), name="organ", required="true", **MADE_UP)
        for name, value in MADE_UP.items():
            given = parameter(config, "/organ/" + name)
            self.assertEqual(given, type(given)(value), name)
        self.assertTrue(node(config, "robot_tissue_node").required)
        self.assertIn("<robot", parameter(config, "/arm_description"))
        self.assertIn(["robot_description", "arm_description"],
                      list(map(list, node(config, "robot_state_publisher").remap_args)))

    def test_what_is_not_given_is_left_to_the_node(self):
        self.assertNotIn("/robot_tissue/state_dir", placed().params)

    def test_the_tissue_is_placed_in_another_frame_than_its_own(self):
        config = placed(parent="world", place="1 2 3", tissue_frame="organ")
        self.assertEqual(node(config, "static_transform_publisher").args, "1.0 2.0 3.0 0 0 0 world organ")
        self.assertEqual(parameter(config, "/robot_tissue/placed_frame"), "organ")
        config = placed(parent="world", tissue_frame="world")
        self.assertNotIn("static_transform_publisher", [each.type for each in config.nodes])
        self.assertEqual(parameter(config, "/robot_tissue/placed_frame"), "")

    def test_relative_paths_start_in_the_working_directory_whatever_the_shell_said(self):
        with tempfile.TemporaryDirectory() as folder:
            here = Path(folder).resolve() / "it's here"
            here.mkdir()
            (here / "a scene.yaml").write_text(Path(SCENE).read_text())
            (here / "way.yaml").write_text("")
            for file, argument, value, name in (
                    ("tissue.launch", "scene", "a scene.yaml", "/robot_tissue/scene_file"),
                    ("demo.launch", "trajectory", "way.yaml", "/demo_player/trajectory"),
                    ("demo.launch", "trajectory", "/else/where.yaml", "/demo_player/trajectory")):
                run = subprocess.run(["roslaunch", "--dump-params", LAUNCH / file, f"{argument}:={value}"], cwd=here,
                                     env={**os.environ, "PWD": "/"}, capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(yaml.safe_load(run.stdout)[name], str(here / value))


if __name__ == "__main__":
    rosunit.unitrun("robot_tissue", "launch_files", LaunchFiles, sysargs=sys.argv)
