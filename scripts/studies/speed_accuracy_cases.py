"""The cases of the study speed_accuracy: scenes by name, and the runs that are made of them."""

import itertools
import math

import yaml

from studies import accuracy
from studies.common import PACKAGE, rows_of

INCREMENT = 0.001  # m that a patch or tool goes in one
SPACINGS = (0.01, 0.005, 0.0025)
TOLERANCES = (0.1, 0.03, 0.01, 0.003, 0.001)
# What the tolerance is to a method that does not take it as an error; the default is all of them.
# None: as exactly as the method can.
OWN_TOLERANCES = {"newton": (None,), "paper": (0.01,)}
# Methods of others (test/benchmark/bullet_peer.cpp) and the model that each has of its own. Their
# tolerance is how far a step may still go, in parts of the increment; at PEER_EXACT they are at their
# own equilibrium.
PEER_MODELS = {"bullet_soft": "links", "bullet_deformable": "tetrahedra"}
PEER_TOLERANCES = (0.1, 0.01, 0.001, None)
PEER_EXACT = 1e-5
# Cases of several increments whose equilibria are not in doubt (press_d10 is, at 0.25): the charts'.
CHARTED = ("press_d5", "drag_d5", "uniaxial", "shear")
FIGURES = ("figure5", "figure6")


def block(nu, spacing, model="elastic"):
    material = {"young_modulus": 1e4}
    if model != "six_spring":
        material["poisson_ratio"] = nu
    return {"shape": {"type": "box", "min": [0.0, 0.0, 0.0], "max": list(accuracy.EXTENT)},
            "spacing": spacing, "model": model, "material": material,
            "fixed": [{"min": [-1.0, -1.0, -1e-6], "max": [1.0, 1.0, 1e-6]}]}


def increments_of(way):
    return math.ceil(way / INCREMENT - 1e-9)


def reference_scene(reference, model, spacing):
    scene = accuracy.scene_of(reference, model, "layered", spacing)
    way = [0.0 if value == "free" else value for value in accuracy.displacement_of(reference)]
    scene["steps"][0]["load"]["increments"] = increments_of(math.hypot(*way))
    return scene


def cut_scene(nu, spacing):
    """Cut 20 mm deep between the nodes of all three lattices, then one bank drawn 5 mm aside."""
    cut = [[0.0512, 0.0212, 0.0288], [0.0512, 0.0788, 0.0288], [0.0512, 0.0788, 0.06],
           [0.0512, 0.0212, 0.06]]
    hook = {"name": "hook", "min": [0.06, 0.04, 0.05], "max": [0.08, 0.06, 0.05],
            "displacement": [0.005, 0.0, 0.0]}
    return {"tissue": block(nu, spacing), "steps": [
        {"cut": {"corners": cut}}, {"load": {"increments": 5, "patches": [hook]}}]}


def two_tool_scene(nu, spacing):
    """Two spheres press by 4 mm each, one after the other, and one is drawn aside by 4 mm."""
    def move(tool, x, from_z, to_x, to_z):
        step = {"tool": tool, "to": {"xyz": [to_x, 0.05, to_z]},
                "increments": increments_of(math.hypot(to_x - x, to_z - (from_z or to_z)))}
        if from_z:
            step["from"] = {"xyz": [x, 0.05, from_z]}
        return {"move": step}
    tools = [{"name": name, "shapes": [{"type": "sphere", "radius": 0.01}]}
             for name in ("left", "right")]
    return {"tissue": block(nu, spacing), "tools": tools, "steps": [
        move("left", 0.03, 0.061, 0.03, 0.056), move("right", 0.07, 0.061, 0.07, 0.056),
        move("right", 0.07, None, 0.066, 0.056)]}


def figure_scene(figure):
    return yaml.safe_load((PACKAGE / f"config/paper_{figure}.yaml").read_text())


def scenes():
    """(case, model, nu, spacing, scene), nu None where the model has none."""
    for reference, spacing in itertools.product(rows_of(accuracy.REFERENCE / "cases.csv"),
                                                SPACINGS):
        case, nu = reference["case"], float(reference["poisson_ratio"])
        yield case, "elastic", nu, spacing, reference_scene(reference, "elastic", spacing)
        yield case, "tetrahedra", nu, spacing, reference_scene(reference, "elastic", spacing)
        if nu == 0.25:  # springs alone have this one
            yield case, "links", None, spacing, reference_scene(reference, "elastic", spacing)
            yield case, "six_spring", None, spacing, reference_scene(reference, "six_spring",
                                                                     spacing)
        if (case, nu) == ("press_d5", 0.45):  # no reference at 0.49: the solver's error alone
            stiff = dict(reference, poisson_ratio="0.49")
            yield case, "elastic", 0.49, spacing, reference_scene(stiff, "elastic", spacing)
    for spacing in SPACINGS:
        yield "cut", "elastic", 0.45, spacing, cut_scene(0.45, spacing)
        yield "two_tools", "elastic", 0.45, spacing, two_tool_scene(0.45, spacing)
    for figure in FIGURES:
        scene = figure_scene(figure)
        yield figure, "six_spring", None, scene["tissue"]["spacing"], scene


class Run:
    """One `simulate`, by what it is of; `key` is the name of its folder."""

    def __init__(self, case, model, nu, spacing, scene, method, tolerance, repeat):
        self.case, self.model, self.nu, self.spacing = case, model, nu, spacing
        self.method, self.tolerance, self.repeat = method, tolerance, repeat
        self.scene = scene
        ratio = "" if nu is None else f"_nu{100 * nu:.0f}"
        self.scene_key = f"{case}_{model}{ratio}_h{1e6 * spacing:.0f}um"
        self.key = (f"{self.scene_key}_{method}_" +
                    ("exact" if tolerance is None else f"t{tolerance:g}") + f"_r{repeat}")

    def lattice(self):
        """What runs have in common that have the same equilibrium."""
        return self.scene_key


def tolerances_of(method):
    if method in PEER_MODELS:
        return PEER_TOLERANCES
    return OWN_TOLERANCES.get(method, TOLERANCES)


def repeats_of(method, case, spacing, tolerance, repeats):
    """Fewer, or none, of what takes long: without that the study takes hours instead of one."""
    slow = spacing < 0.005
    if method in PEER_MODELS:
        if slow:
            return 1 if case == "press_d5" and tolerance != 0.001 else 0
        most = 1 if method == "bullet_deformable" and spacing < 0.01 else 2
        return min(repeats, most) if case in CHARTED else 0
    if method == "newton":
        return 0 if slow and case not in (*CHARTED, "press_d1") else 1
    if method == "xpbd":
        return 0 if slow and tolerance < 0.01 else 1
    if slow and case == "two_tools" and method != "layered":
        return 1 if tolerance in (0.1, 0.01) else 0
    if case not in CHARTED:
        return 1  # no chart shows their spread
    return min(repeats, 2) if slow else repeats


def runs(methods_of, repeats, whole):
    """All runs, so ordered that a study stopped early has something of everything: first repeats
    first, coarse lattices first, the exact ones last. `whole`: also those that take long."""
    found = []
    for case, model, nu, spacing, scene in scenes():
        for method in methods_of(model):
            for tolerance in tolerances_of(method):
                most = repeats if whole else repeats_of(method, case, spacing, tolerance, repeats)
                if tolerance is None:
                    most = min(most, 1)
                found += [Run(case, model, nu, spacing, scene, method, tolerance, repeat)
                          for repeat in range(1, most + 1)]
    return sorted(found, key=lambda run: (run.repeat, -run.spacing, run.tolerance is None))
