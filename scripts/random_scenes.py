"""Small scenes for scripts/mutate_scenes: legal ones at random, and what changes them."""

import copy
import math
import random
import struct

import yaml

OPTIONS = [["--method", "newton"], ["--method", "vbd"], ["--method", "xpbd"], ["--method", "explicit"],
           ["--tolerance", "0.5"], ["--tolerance", "1e-5"], ["--threads", "2"], ["--quiet"],
           ["--max-seconds", "0.01"]]
NUMBERS = [0, -1, 1, -0.0, 1e-300, -1e-300, 1e-30, 1e-9, 1e-3, 0.01, 0.02, 0.1, 0.49, 0.5, 10.0, 1e3, 1e9,
           1e15, 1e300, -1e300, 2**31, 2**63, float("nan"), float("inf"), -float("inf")]
WORDS = ["nan", ".inf", "1e400", "", "~", "yes", "free", "box", "0x10", "1_000", "a,b", "\"", "\n", "ä" * 50,
         "x" * 5000, "../..", "/dev/null", "p", "probe"]
TOOLS = ["probe", "plate", "forceps", "knife", "shears", "burr"]
NAMES = [*TOOLS, "nobody"]
FILES = ["a.tissue", "b.tissue"]
JAWED = ("forceps", "shears")


def vector(rng, low, high):
    return [round(rng.uniform(low, high), 5) for _ in range(3)]


def place(rng, opening=False):
    at = {"xyz": [round(rng.uniform(-0.05, 0.13), 4), round(rng.uniform(-0.05, 0.13), 4),
                  round(rng.uniform(-0.03, 0.14), 4)]}
    if rng.random() < 0.5:
        at["rpy"] = vector(rng, -3.0, 3.0)
    if opening:
        at["opening"] = round(rng.choice([0.0, 0.004, 0.01, 0.03]), 4)
    return at


def random_move(rng):
    tool = rng.choice(TOOLS)
    move = {"tool": tool, "to": place(rng, tool in JAWED), "increments": rng.choice([1, 2, 3, 7])}
    if rng.random() < 0.9:
        move["from"] = place(rng, tool in JAWED)
    return {"move": move}


def random_load(rng):
    low = [round(rng.choice([0.0, 0.02, 0.04, 0.06]), 3) for _ in range(2)] + [0.04]
    patch = {"name": rng.choice(["p", "q"]), "min": low, "max": [low[0] + 0.02, low[1] + 0.02, 0.04]}
    patch[rng.choice(["displacement", "force"])] = vector(rng, -0.02, 0.02)
    if rng.random() < 0.2:
        patch["turns"] = True
    load = {"patches": [patch]}
    if rng.random() < 0.5:
        load["increments"] = rng.choice([1, 2, 5])
    return {"load": load}


def random_suture(rng):
    ends = [[round(rng.uniform(0.0, 0.1), 3), round(rng.uniform(0.0, 0.08), 3), 0.04] for _ in range(2)]
    more = {"name": ["a", "b"], "rest_length": [0.0, 0.01, 0.5], "stiffness": [1.0, 200.0, 1e5],
            "break_force": [0.0, 0.01, 1.0], "bite": [0.0, 0.004, 0.05]}
    suture = {key: rng.choice(values) for key, values in more.items() if rng.random() < 0.5}
    return {"suture": {"from": ends[0], "to": rng.choice([ends[1], vector(rng, -0.1, 0.15)]), **suture}}


def random_removal(rng):
    if rng.random() < 0.5:
        return {"remove": {"sphere": {"center": vector(rng, 0.0, 0.08), "radius": rng.choice([0.005, 0.02, 0.2])}}}
    return {"remove": {"box": {"min": [0.015, -0.01, 0.01], "max": [rng.choice([0.02, 0.05, 0.1]), 0.09, 0.05]}}}


def random_step(rng):
    return rng.choice([
        random_move, random_move, random_move, random_load, random_load, random_load, random_suture,
        lambda r: {"settle": {}},
        lambda r: {"reset": {}},
        lambda r: {"cut": {"corners": [[0.05, -0.01, 0.01], [0.05, 0.09, 0.01], [0.05, 0.09, 0.05],
                                       [0.05, -0.01, 0.05]]}},
        lambda r: {"cut": {"corners": [vector(r, -0.1, 0.15) for _ in range(r.choice([3, 4, 7]))]}},
        lambda r: {"push": {"tool": r.choice(NAMES[:3]), "force": vector(r, -0.5, 0.5), "increments": 1}},
        lambda r: {"grasp": {"tool": r.choice(NAMES)}},
        lambda r: {"release": {"tools": [r.choice(NAMES)]}},
        lambda r: {"release": {"patches": [r.choice(["p", "q"])]}},
        random_removal,
        lambda r: {"undo": r.choice([{}, {"count": 1}, {"count": 2}])},
        lambda r: {"save": {"file": r.choice(FILES)}},
        lambda r: {"load_state": {"file": r.choice(FILES)}},
    ])(rng)


def random_shape(rng):
    return rng.choice([
        lambda: {"type": "sphere", "radius": rng.choice([0.001, 0.01, 0.03])},
        lambda: {"type": "cylinder", "radius": rng.choice([0.001, 0.01]), "length": rng.choice([0.01, 0.06])},
        lambda: {"type": "box", "size": [rng.choice([0.0005, 0.01, 0.05]) for _ in range(3)]},
        lambda: {"type": "mesh", "resource": "mesh.stl", "scale": rng.choice([1.0, 0.3])},
    ])()


def random_support(rng):
    if rng.random() < 0.5:
        return {"type": "plane", "point": [0, 0, round(rng.uniform(-0.01, 0.02), 4)],
                "normal": rng.choice([[0, 0, 1], [0.1, 0, 1], [0, 0, -1]])}
    return {"type": "box", "min": [0.08, 0, 0], "max": [0.1, 0.08, 0.05], "friction": rng.choice([0, 0.5])}


def random_region(rng):
    return {"young_modulus": rng.choice([1.0e3, 1.0e5]), **rng.choice([
        lambda: {"min": [0, 0, 0], "max": [0.04, 0.08, 0.02]},
        lambda: {"shape": {"type": "box", "min": [0, 0, 0], "max": [0.04, 0.08, 0.02]}},
        lambda: {"shape": {"type": "mesh", "resource": "mesh." + rng.choice(["stl", "obj", "dae"]),
                           "scale": rng.choice([0.5, 0.8, [1.2, 0.4, 0.9]])}},
    ])()}


def random_membrane(rng):
    return {"thickness": rng.choice([0.0001, 0.0005, 0.02]), "young_modulus": rng.choice([1.0e4, 1.0e6]),
            **rng.choice([{}, {"side": "outer", "pressure": rng.choice([-20.0, 20.0])},
                          {"boxes": [{"min": [-1, -1, 0.03], "max": [1, 0.05, 1]}]}])}


def base_scene(rng):
    """Legal, of 75 nodes or fewer."""
    scene = {
        "tissue": {
            "shape": {"type": "box", "min": [0, 0, 0], "max": [0.08, 0.08, 0.04]},
            "spacing": 0.02,
            "material": {"young_modulus": 1.0e4, "poisson_ratio": rng.choice([0.25, 0.3, 0.45, 0.49])},
            "fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}],
        },
        "solver": {"tolerance": rng.choice([0.05, 0.01, 0.001])},
        "tools": [
            {"name": "probe", "shapes": [random_shape(rng)], "friction": rng.choice([0, 0.3, 1.0])},
            {"name": "plate", "patch": rng.choice(["rigid", "conforming"]),
             "shapes": [{"type": "box", "size": [0.03, 0.03, 0.004]}]},
            {"name": "forceps", "role": "grasper",
             "jaws": [{"shapes": [{"type": "box", "size": [0.01, 0.004, 0.02]}]} for _ in range(2)],
             "grasp": {"close_gap": 0.012, "opening_axis": [0, 1, 0], "max_force": rng.choice([0, 0.01, 1.0]),
                       "on_max_force": rng.choice(["release", "tear"])}},
            {"name": "knife", "role": "blade", "resistance": rng.choice([0, 200.0]),
             "edge": [[0, 0, -0.03], [0.01, 0, 0], [0, 0, 0.03]][:rng.choice([2, 3])]},
            {"name": "shears", "role": "scissors", "opening_axis": [0, 0, 1],
             "jaws": [{"shapes": [{"type": "box", "size": [0.03, 0.002, 0.002]}]} for _ in range(2)],
             "edges": [[[0, 0, -0.001], [0.03, 0, 0.001 * rng.choice([1, 5])]],
                       [[0, 0, 0.001], [0.03, 0, -0.001 * rng.choice([1, 5])]]]},
            {"name": "burr", "role": "burr", "shapes": [{"type": "sphere", "radius": rng.choice([0.004, 0.012])}]},
        ],
        "steps": [
            {"move": {"tool": "probe", "from": {"xyz": [0.04, 0.04, 0.08]},
                      "to": {"xyz": [0.04, 0.04, 0.055]}, "increments": 2}}] if rng.random() < 0.6 else [],
    }
    kind = rng.random()
    if kind < 0.25:
        scene["tissue"]["shape"] = {"type": "mesh", "resource": "mesh." + rng.choice(["stl", "obj", "dae"])}
    elif kind < 0.35:
        scene["tissue"]["model"] = "six_spring"
        scene["tools"] = [tool for tool in scene["tools"] if tool.get("patch") == "rigid"]
        scene["steps"] = []
    if rng.random() < 0.3:
        scene["tissue"]["material"].update({"law": "fung", "stiffening": rng.choice([0, 5.0, 300.0])})
    elif rng.random() < 0.2:
        scene["tissue"]["material"] = {"preset": rng.choice(["liver", "fat", "brain", "silicone"])}
    if rng.random() < 0.2:
        scene["tissue"]["material"]["tear_stretch"] = rng.choice([1.1, 1.5])
    if rng.random() < 0.2 and scene["tissue"].get("model") != "six_spring":
        scene["tissue"]["regions"] = [random_region(rng) for _ in range(rng.choice([1, 2]))]
    if rng.random() < 0.15 and scene["tissue"].get("model") != "six_spring":
        scene["tissue"]["membranes"] = [random_membrane(rng) for _ in range(rng.choice([1, 2]))]
    if rng.random() < 0.3:
        scene["supports"] = [random_support(rng)]
    if rng.random() < 0.3:
        scene["tissue"]["gravity"] = [0, 0, -1.0]
    scene["steps"] += [random_step(rng) for _ in range(rng.randint(0, 3))]
    if rng.random() < 0.15:  # what no earlier step has saved is refused
        scene["steps"] += [{"save": {"file": FILES[0]}}, random_step(rng), {"load_state": {"file": FILES[0]}}]
    if rng.random() < 0.2:
        take_time(rng, scene)
    return scene


def take_time(rng, scene):
    """Most of its moves, and what follows each step."""
    scene["tissue"]["time"] = {"damping_time": rng.choice([0, 0.002, 0.02, 0.2])}
    for step in scene["steps"]:
        if "move" in step and rng.random() < 0.8:
            step["move"]["duration"] = rng.choice([0.005, 0.1, 1.0])
    waits = [{"wait": {"duration": rng.choice([0.001, 0.05, 0.5]), "increments": rng.choice([1, 3])}}
             for _ in scene["steps"]]
    scene["steps"] = [step for pair in zip(scene["steps"], waits) for step in pair]


def slots(node):
    """All (container, key) below a node."""
    found = []
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else []
    for key, value in list(entries):
        found.append((node, key))
        found += slots(value)
    return found


def mutate_value(rng, scene):
    container, key = rng.choice(slots(scene))
    old = container[key]
    if isinstance(old, (int, float)) and not isinstance(old, bool) and rng.random() < 0.7:
        container[key] = rng.choice(NUMBERS + [old * 10.0 ** rng.randint(-6, 6), -old, old * 1.001, old / 3.0])
    else:
        container[key] = copy.deepcopy(rng.choice([*NUMBERS, *WORDS, [], {}, None, True, [old], {"a": old}]))


def mutate_key(rng, scene):
    maps = [(container, key) for container, key in slots(scene) if isinstance(container, dict)]
    container, key = rng.choice(maps)
    chance = rng.random()
    value = container[key]
    if chance < 0.5:
        del container[key]
    elif chance < 0.75:
        del container[key]
        container[key[:-1] + rng.choice("xyz")] = value
    else:
        container[rng.choice(["extra", "type", "min", "force", "shapes", "increments"])] = value


def mutate_steps(rng, scene):
    steps = scene.get("steps")
    if not isinstance(steps, list):
        return
    chance = rng.random()
    if chance < 0.6 or not steps:
        steps.insert(rng.randint(0, len(steps)), random_step(rng))
    elif chance < 0.75:
        rng.shuffle(steps)
    else:
        steps.insert(rng.randint(0, len(steps)), copy.deepcopy(rng.choice(steps)))


def mutate_list(rng, scene):
    lists = [value for container, key in slots(scene)
             for value in [container[key]] if isinstance(value, list) and value]
    if not lists:
        return
    chosen = rng.choice(lists)
    if rng.random() < 0.5:
        chosen.append(copy.deepcopy(rng.choice(chosen)))
    else:
        del chosen[rng.randrange(len(chosen))]


def mutate_tool(rng, scene):
    tools = scene.get("tools")
    if isinstance(tools, list) and tools and isinstance(tools[0], dict):
        tools[0]["shapes"] = [random_shape(rng) for _ in range(rng.randint(1, 2))]
        tools[0]["padding"] = rng.choice([0.0, 0.002])


def mutate_supports(rng, scene):
    scene["supports"] = [random_support(rng) for _ in range(rng.randint(1, 3))]


MUTATIONS = [mutate_value, mutate_value, mutate_key, mutate_steps, mutate_steps, mutate_list, mutate_tool,
             mutate_supports]


CORNERS = [[x, y, z] for z in (0, 0.04) for y in (0, 0.08) for x in (0, 0.08)]
FACES = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2],
         [2, 4, 6], [1, 3, 5], [3, 7, 5]]


def stl():
    data = b"cube".ljust(80) + struct.pack("<I", len(FACES))
    for face in FACES:
        data += struct.pack("<3f", 0, 0, 0)
        for corner in face:
            data += struct.pack("<3f", *CORNERS[corner])
        data += struct.pack("<H", 0)
    return data


def obj():
    lines = ["v %g %g %g" % tuple(corner) for corner in CORNERS]
    lines += ["f %d %d %d" % tuple(corner + 1 for corner in face) for face in FACES]
    return ("\n".join(lines) + "\n").encode()


def dae():
    points = " ".join("%g" % number for corner in CORNERS for number in corner)
    indices = " ".join(str(corner) for face in FACES for corner in face)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="24">{points}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>
""".encode()


def mutate_bytes(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 3, 20])):
        chance, at = rng.random(), rng.randrange(len(data))
        if chance < 0.6:
            data[at] = rng.randrange(256)
        elif chance < 0.75:
            del data[at:]
        elif chance < 0.9:
            end = min(len(data), at + rng.randint(1, 64))
            data[at:at] = data[at:end]
        else:
            data[at:at + 4] = struct.pack("<f", rng.choice([math.nan, math.inf, 1e30, -1e-30]))
        if not data:
            break
    return bytes(data)


def write_case(rng, folder):
    """Writes scene.yaml and its meshes; returns further arguments."""
    meshes = {"mesh.stl": stl(), "mesh.obj": obj(), "mesh.dae": dae()}
    scene = base_scene(rng)
    for _ in range(rng.choice([0, 0, 1, 1, 2])):
        rng.choice(MUTATIONS)(rng, scene)
    if rng.random() < 0.3:
        meshes = {name: mutate_bytes(rng, data) for name, data in meshes.items()}
    elif rng.random() < 0.05:
        meshes = dict(zip(meshes, reversed(list(meshes.values()))))
    for name, data in meshes.items():
        (folder / name).write_bytes(data)
    text = yaml.safe_dump(scene, allow_unicode=True).encode()
    if rng.random() < 0.05:
        text = mutate_bytes(rng, text)
    (folder / "scene.yaml").write_bytes(text)
    return rng.choice(OPTIONS) if rng.random() < 0.15 else []
