"""Measures motion in time: bars that swing against beam theory, and tools that are dragged.

A bar of 400 x 40 x 40 mm, clamped at one end, is let go: frequencies and damping of bending, and of stretching, where
a stress wave runs to and fro. A sphere and a box's edge are dragged over a block, 200 poses a second, with time and
without: milliseconds a pose, and how the force jumps from pose to pose. A soft bar is squeezed far beyond where it
buckles, and let go.
Out: doc/data/motion.csv, doc/data/motion_drag.csv, doc/data/motion_squeezed.csv, doc/images/motion.png.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

from studies.common import (DATA, IMAGES, add_plot, add_programs, numbers, percentile, print_rows,
                            program, progress, pyplot, rows_of, worst, write_rows)

BARS, DRAGS, SWING = DATA / "motion.csv", DATA / "motion_drag.csv", DATA / "motion_swing.csv.gz"
SQUEEZED = DATA / "motion_squeezed.csv"
LENGTH, THICK, MODULUS, POISSON, DENSITY = 0.4, 0.04, 1e7, 0.25, 1000.0
INTERVAL = 0.001                # s, between rows
FREE = "free"


def beam_frequencies(elements=200):
    """Hz, of a clamped bar's bending by Timoshenko's theory: finite elements with one point each."""
    size, inertia = LENGTH / elements, THICK ** 2 / 12.0  # of a unit of area
    shear = 5.0 / 6.0 * MODULUS / (2.0 * (1.0 + POISSON))
    count = 2 * (elements + 1)  # deflection and turn of each node
    stiffness, mass = np.zeros((count, count)), np.zeros(count)
    for element in range(elements):
        nodes = slice(2 * element, 2 * element + 4)
        slope = np.array([-1.0 / size, -0.5, 1.0 / size, -0.5])
        turn = np.array([0.0, -1.0 / size, 0.0, 1.0 / size])
        stiffness[nodes, nodes] += size * (shear * np.outer(slope, slope) +
                                           MODULUS * inertia * np.outer(turn, turn))
        mass[nodes] += DENSITY * size / 2.0 * np.array([1.0, inertia, 1.0, inertia])
    root = 1.0 / np.sqrt(mass[2:])
    squares = np.linalg.eigvalsh(stiffness[2:, 2:] * np.outer(root, root))
    return np.sqrt(squares[:2]) / (2.0 * math.pi)


def patch(name, place, way, wide=True):
    low, high = (0.0, THICK) if wide else (THICK / 2, THICK / 2)
    return {"name": name, "min": [place, low, low], "max": [place, high, high],
            "displacement": way}


# Name, cells of the thickness, damping time (s), tolerance, duration (s), axis of the tip, patches that bend it,
# frequency by theory (Hz).
def cases():
    spacing = THICK / 4
    near_tip = LENGTH - spacing
    first = [("bend", near_tip, [FREE, FREE, -0.004])]
    second = [("belly", 0.2, [FREE, FREE, 0.002]), ("bend", near_tip, [FREE, FREE, -0.002])]
    stretch = [("bend", near_tip, [0.002, FREE, FREE])]
    slow, fast = beam_frequencies()
    wave = math.sqrt(MODULUS / DENSITY) / (4.0 * LENGTH)
    return [("first bending", 4, 0.0, 0.01, 3.0, "uz", first, slow),
            ("first bending", 4, 0.0, 0.05, 3.0, "uz", first, slow),
            ("first bending", 4, 0.0, 0.002, 3.0, "uz", first, slow),
            ("first bending", 8, 0.0, 0.01, 1.0, "uz", first, slow),
            ("first bending, damped", 4, 0.002, 0.01, 2.0, "uz", first, slow),
            ("second bending", 4, 0.0, 0.01, 0.5, "uz", second, fast),
            ("second bending", 8, 0.0, 0.01, 0.5, "uz", second, fast),
            ("stretching", 4, 0.0, 0.01, 0.2, "ux", stretch, wave)]


def bar_scene(cells, damping_time, tolerance, duration, bends):
    patches = [patch(name, place, way) for name, place, way in bends]
    patches.append(patch("tip", LENGTH, [FREE, 0.0, FREE], wide=False))
    return {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [LENGTH, THICK, THICK]},
                       "spacing": THICK / cells,
                       "material": {"young_modulus": MODULUS, "poisson_ratio": POISSON,
                                    "density": DENSITY},
                       "fixed": [{"min": [-1, -1, -1], "max": [1e-6, 1, 1]}],
                       "time": {"damping_time": damping_time}},
            "solver": {"tolerance": tolerance},
            "steps": [{"load": {"patches": patches}},
                      {"release": {"patches": [name for name, _, _ in bends]}},
                      {"wait": {"duration": duration,
                                "increments": round(duration / INTERVAL)}}]}


def simulated(simulate, scene):
    """Folder of the results."""
    folder = tempfile.TemporaryDirectory()
    file = Path(folder.name) / "scene.yaml"
    file.write_text(yaml.safe_dump(scene))
    done = subprocess.run([simulate, file, "--out", folder.name, "--quiet"], capture_output=True,
                          text=True)
    if done.returncode not in (0, 3):
        sys.exit("motion: " + done.stderr.strip())
    return folder


def frequency_near(times, values, guess):
    """Of the harmonic between 0.8 and 1.2 times the guess that explains most of the motion."""
    def explained(frequency):
        phase = 2.0 * math.pi * frequency * times
        basis = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)
        return np.sum((basis @ np.linalg.lstsq(basis, values, rcond=None)[0]) ** 2)
    tried = np.linspace(0.8 * guess, 1.2 * guess, 801)
    return tried[np.argmax([explained(frequency) for frequency in tried])]


def zeros_and_peaks(times, values):
    zeros, peaks = [], []
    for i in range(len(values) - 1):
        if values[i] * values[i + 1] < 0.0:
            zeros.append(i)
    for low, high in zip(zeros, zeros[1:]):
        peaks.append(np.abs(values[low:high + 1]).max())
    return zeros, peaks


def measure_bar(simulate, case):
    name, cells, damping_time, tolerance, duration, axis, bends, theory = case
    with simulated(simulate, bar_scene(cells, damping_time, tolerance, duration, bends)) as folder:
        patches = [row for row in rows_of(Path(folder) / "patches.csv") if row["step"] == "2"]
        rows = [row for row in rows_of(Path(folder) / "increments.csv") if row["step"] == "2"]
    times, tip = np.array(numbers(rows, "time")), np.array(numbers(patches, axis))
    found = frequency_near(times, tip, theory)
    _, peaks = zeros_and_peaks(times, tip)
    ratio = math.log(peaks[0] / peaks[-1]) / ((len(peaks) - 1) * math.pi) if len(peaks) > 2 else 0.0
    row = {"case": name, "cells": cells, "damping_time_s": damping_time, "tolerance": tolerance,
           "status": worst(rows), "frequency_Hz": f"{found:.4g}", "theory_Hz": f"{theory:.4g}",
           "damping_ratio": f"{ratio:.3g}",
           "theory_damping_ratio": f"{math.pi * found * damping_time:.3g}",
           "left_after_10_periods": f"{math.exp(-2.0 * math.pi * ratio * 10.0):.3g}",
           "ms_a_simulated_ms": f"{sum(numbers(rows, 'update_ms')) / (1e3 * duration):.3g}"}
    swing = [{"case": name, "cells": cells, "damping_time_s": damping_time, "tolerance": tolerance,
              "time": f"{time:.4g}", "tip": f"{place:.5g}"} for time, place in zip(times, tip)]
    return row, swing


def drag_scene(shape, height, spacing, damping_time):
    def there(x, z):
        return {"xyz": [x, 0.05, z]}
    with_time = damping_time is not None
    duration = {"duration": 0.25} if with_time else {}
    long = {"duration": 1.25} if with_time else {}
    scene = {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.05]},
                        "spacing": spacing, "material": {"young_modulus": 1e4},
                        "fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}]},
             "tools": [{"name": "tool", "link": "tool", "friction": 0.3, "shapes": [shape]}],
             "steps": [{"move": {"tool": "tool", "from": there(0.035, 0.0505 + height),
                                 "to": there(0.035, 0.045 + height), "increments": 50, **duration}},
                       {"move": {"tool": "tool", "to": there(0.06, 0.045 + height),
                                 "increments": 250, **long}}]}
    if with_time:
        scene["tissue"]["time"] = {"damping_time": damping_time}
    return scene


TOOLS = {"sphere": ({"type": "sphere", "radius": 0.01}, 0.01),
         "box, edge": ({"type": "box", "size": [0.02, 0.02, 0.02], "rpy": [0, math.pi / 4, 0]},
                       0.01 * math.sqrt(2.0))}
DAMPING_TIMES = (None, 0.01, 0.03, 0.1)  # s; None: no time


def measure_drag(simulate, tool, spacing, damping_time):
    shape, height = TOOLS[tool]
    with simulated(simulate, drag_scene(shape, height, spacing, damping_time)) as folder:
        rows = [row for row in rows_of(Path(folder) / "increments.csv") if row["step"] == "1"]
        forces = np.array([[float(row[axis]) for axis in ("fx", "fy", "fz")]
                           for row in rows_of(Path(folder) / "tools.csv") if row["step"] == "1"])
    ms = numbers(rows, "update_ms")
    jumps = np.linalg.norm(np.diff(forces, axis=0), axis=1)
    greatest = np.linalg.norm(forces, axis=1).max()
    return {"tool": tool, "spacing_m": spacing,
            "damping_time_s": "" if damping_time is None else damping_time,
            "status": worst(rows), "median_ms": f"{percentile(ms, 50):.3g}",
            "mean_ms": f"{sum(ms) / len(ms):.3g}", "percentile_99_ms": f"{percentile(ms, 99):.3g}",
            "greatest_N": f"{greatest:.3g}", "greatest_jump_percent":
            f"{100.0 * jumps.max() / greatest:.3g}"}


BAR_WIDE, BAR_HIGH = 0.02, 0.08     # m
SQUEEZES = (0.008, 0.02)            # m
SQUEEZED_FOR = (0.02, 0.05, 0.1, 0.2)  # s


def squeezed_scene(method, damping_time, squeeze, duration):
    top = {"name": "top", "min": [-1, -1, BAR_HIGH - 1e-6], "max": [1, 1, 1], "displacement": [0, 0, -squeeze]}
    return {"tissue": {"shape": {"type": "box", "min": [0, 0, 0], "max": [BAR_WIDE, BAR_WIDE, BAR_HIGH]},
                       "spacing": 0.005, "material": {"young_modulus": 1e4, "poisson_ratio": 0.45},
                       "fixed": [{"min": [-1, -1, -1e-6], "max": [1, 1, 1e-6]}],
                       "time": {"damping_time": damping_time}},
            "solver": {"method": method},
            "steps": [{"load": {"patches": [top]}}, {"release": {"patches": ["top"]}},
                      {"wait": {"duration": duration, "increments": 1}}]}


def measure_squeezed(simulate, method, damping_time, squeeze, duration):
    with simulated(simulate, squeezed_scene(method, damping_time, squeeze, duration)) as folder:
        rows = [row for row in rows_of(Path(folder) / "increments.csv") if row["step"] == "2"]
        nodes = np.array([[float(row[axis]) for axis in ("x", "y", "z", "ux", "uy", "uz")]
                          for row in rows_of(Path(folder) / "nodes.csv")])
    top = nodes[nodes[:, 2] > BAR_HIGH - 1e-6]
    middle = np.abs(top[:, :2] - BAR_WIDE / 2.0).max(axis=1) < 1e-6
    return {"method": method, "damping_time_s": damping_time, "squeezed_m": squeeze, "time_s": duration,
            "status": worst(rows), "left_of_way": f"{-top[:, 5].mean() / squeeze:.3g}",
            "aside_mm": f"{1e3 * np.linalg.norm(top[middle][0, 3:5]):.3g}",
            "ms_a_simulated_ms": f"{sum(numbers(rows, 'update_ms')) / (1e3 * duration):.3g}"}


def measure(options):
    simulate = program("simulate", options.programs)
    bars, swings = [], []
    for case in progress(cases(), lambda case: case[0]):
        row, swing = measure_bar(simulate, case)
        bars.append(row)
        swings += swing
    drags = [measure_drag(simulate, tool, 0.005, damping_time)
             for tool in TOOLS for damping_time in DAMPING_TIMES]
    squeezed = [measure_squeezed(simulate, method, damping_time, squeeze, duration)
                for method, damping_times in (("layered", (0.01, 0.03, 0.1, 0.3)), ("newton", (0.03, 0.1)))
                for damping_time in damping_times for squeeze in SQUEEZES for duration in SQUEEZED_FOR]
    write_rows(SQUEEZED, list(squeezed[0]), squeezed)
    write_rows(BARS, list(bars[0]), bars)
    write_rows(SWING, list(swings[0]), swings)
    write_rows(DRAGS, list(drags[0]), drags)


def draw():
    plt = pyplot()
    rows = rows_of(SWING)
    figure, axes = plt.subplots(figsize=(8, 3.2))
    for tolerance, damping, style in (("0.01", "0.0", "-"), ("0.05", "0.0", ":"),
                                      ("0.01", "0.002", "--")):
        picked = [row for row in rows if row["case"].startswith("first") and row["cells"] == "4" and
                  row["tolerance"] == tolerance and row["damping_time_s"] == damping]
        axes.plot(numbers(picked, "time"), [1e3 * tip for tip in numbers(picked, "tip")], style,
                  label=f"tolerance {tolerance}, damping time {damping} s", linewidth=1.0)
    axes.set(xlabel="time (s)", ylabel="tip (mm)", xlim=(0, 2), ylim=(-4.8, 7.2),
             title="A clamped bar of 400 x 40 x 40 mm is let go")
    axes.legend(fontsize=7, loc="upper right")
    figure.tight_layout()
    figure.savefig(IMAGES / "motion.png", dpi=120)


def add_arguments(parser):
    add_programs(parser)
    add_plot(parser)


def run(options):
    if not options.plot:
        measure(options)
    draw()
    print_rows(rows_of(BARS) + rows_of(DRAGS) + rows_of(SQUEEZED))
