"""Runs a study, or all of them: see `scripts/study --help`."""

import argparse
import ast
import importlib
import sys
import time
from pathlib import Path

# In the order in which `all` runs them: short ones first.
STUDIES = ["rooms", "grasp", "dent_folds", "slides", "liver", "walls", "paper", "motion", "swing", "time_stability",
           "time_tools", "stiffening", "economy", "fidelity", "growth", "threads", "stages", "speed", "node",
           "still_node", "shape_topics", "replay_live", "screens", "soak", "heap", "contact_search", "contact",
           "tool_accuracy", "accuracy", "stability", "speed_accuracy"]


def title_of(name):
    """The first line of the module's own words, without loading it: some need ROS."""
    text = (Path(__file__).parent / f"{name}.py").read_text()
    return ast.get_docstring(ast.parse(text)).splitlines()[0]


def parser_of(modules):
    parser = argparse.ArgumentParser(
        prog="scripts/study", description="Measures what doc/ tells: each study writes its table "
        "in doc/data and draws its pictures in doc/images from it.")
    parser.add_argument("--list", action="store_true", help="names the studies, a line each")
    studies = parser.add_subparsers(dest="study", metavar="STUDY")
    for name in STUDIES:
        title = title_of(name).replace("%", "%%")  # argparse formats it
        own = studies.add_parser(name, help=title,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
        if name in modules:
            own.description = modules[name].__doc__
            modules[name].add_arguments(own)
    every = studies.add_parser("all", help="every study with its defaults, one after the other")
    every.add_argument("--plot", action="store_true",
                       help="measure nothing: pictures and tables from what is committed")
    return parser


def defaults_of(module, plot):
    """The module's own, without arguments; None where it draws nothing from a table."""
    parser = argparse.ArgumentParser()
    module.add_arguments(parser)
    options = parser.parse_args([])
    if not plot:
        return options
    if not hasattr(options, "plot"):
        return None
    options.plot = True
    return options


def run_all(modules, plot):
    for place, (name, module) in enumerate(modules.items(), start=1):
        options = defaults_of(module, plot)
        if options is None:
            continue
        print(f"== {place}/{len(modules)} {name}", flush=True)
        start = time.monotonic()
        module.run(options)
        print(f"== {name}: {time.monotonic() - start:.0f} s", flush=True)


def wanted_modules(words):
    """Only what is asked for is loaded: some studies need ROS, or packages that others do not."""
    wanted = STUDIES if "all" in words[:1] else [word for word in words[:1] if word in STUDIES]
    return {name: importlib.import_module(f"studies.{name}") for name in wanted}


def main():
    try:
        run(sys.argv[1:])
    except ModuleNotFoundError as missing:
        sys.exit(f"study: {missing.name} is missing; install what scripts/study_packages lists, "
                 "and for studies of the node source the build's devel/setup.bash")


def run(words):
    modules = wanted_modules(words)
    parser = parser_of(modules)
    options = parser.parse_args(words)
    if options.list:
        for name in STUDIES:
            print(f"{name:15} {title_of(name)}")
    elif options.study == "all":
        run_all(modules, options.plot)
    elif options.study:
        modules[options.study].run(options)
    else:
        parser.error("which study? allowed: all, " + ", ".join(STUDIES))


if __name__ == "__main__":
    main()
