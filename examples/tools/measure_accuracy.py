#!/usr/bin/env python3
"""Holds the estimated error of the relative density against the true one, on varied hot pressings.

    examples/tools/measure_accuracy.py --out DIR [--scenes 24] [--accuracy standard] [--seed 20] [--cells]
        [--program ./densify]

Every scene is drawn from lists of materials, particle numbers, containers, densities, pressures and temperatures, or with
--cells from cells under pressure from all sides, in a die, or let go when necks hold.  Its converged densities are the means of eight runs from one packing, perturbed by 1e-3 of the radius, with accuracy =
3.3e-4; the run that is judged is one more, with accuracy as asked.  The true error is the largest difference at the
ends of the stages: the noise of the judged run is part of it, that of the converged mean stands beside it.
"""

import argparse
import csv
import pathlib
import random
import shlex
import statistics
import subprocess
import sys

HEAT = {"NiAl": (1150, 1400), "Cu": (650, 950), "Al2O3": (1250, 1500)}  # degC
CONTACT = """[contact]
elasticity = "hertz"
damping_ratio = 0.1
[contact.sintering]
model = "viscoelastic"
update = "backward_euler"
relaxation_time = "60 s"
viscosity_before = "1e12 N s/m"
damping_ratio = 0.3
"""
ROOT = pathlib.Path(__file__).resolve().parents[2]


def powder(title, material, particles, mean, spread, ratio):
    return f"""title = "Accuracy, {title}"
[materials.{material}]
library = "{material}"
[[powder]]
material = "{material}"
number = {particles}
sizes = "lognormal"
mean = "{mean} um"
standard_deviation = "{spread:.4g} um"
minimum = "{mean / ratio**0.5 * 0.9:.4g} um"
maximum = "{mean * ratio**0.5 * 1.1:.4g} um"
"""


def process(load, peak, rate, hold, unloading, letting_go=""):
    return f"""[process]
start_temperature = "20 degC"
[[process.stage]]
name = "loading"
duration = "20 min"
{load}
[[process.stage]]
name = "heating"
rate = "{rate} K/min"
temperature = "{peak} degC"
{letting_go}[[process.stage]]
name = "hold"
duration = "{hold} min"
[[process.stage]]
name = "cooling"
duration = "60 min"
temperature = "20 degC"
{unloading}[output]
visualisation = false
"""


def path(rng, pressure, peak, rate, hold):
    """What drives a cell, as stages."""
    kind = rng.choice(["all sides", "die", "free"])
    load = f'pressure = "{pressure} MPa"'
    if kind == "die":
        load = f'stress = {{ zz = "-{pressure} MPa" }}\nstrain_rate = {{ xx = "0 1/s", yy = "0 1/s" }}'
    letting_go = f'[[process.stage]]\nname = "letting go"\nduration = "10 min"\npressure = "0 Pa"\n' if kind == "free" else ""
    unloading = "" if kind == "free" else (
        '[[process.stage]]\nname = "unloading"\nduration = "20 min"\n'
        + ('stress = { zz = "0 Pa" }' if kind == "die" else 'pressure = "0 Pa"') + "\n")
    return kind, process(load, peak, rate, hold, unloading, letting_go)


def cell(rng, number):
    material = rng.choice(["NiAl", "NiAl", "Cu", "Al2O3"])
    particles = rng.choice([100, 200, 300, 500])
    ratio = rng.choice([1.0, 2.0, 4.0])
    mean = rng.choice([4.0, 8.0, 15.0])
    pressure = rng.choice([3, 8, 15, 30, 45])
    peak = rng.randint(*HEAT[material])
    rate = rng.choice([5, 15, 40])
    hold = rng.choice([5, 15, 40])
    closing = rng.random() < 0.5
    kind, stages = path(rng, pressure, peak, rate, hold)
    spread = {1.0: 0.05, 2.0: 0.2, 4.0: 0.35}[ratio] * mean
    what = f"{material}, {particles}, {kind}, {pressure} MPa, {peak} degC, {rate} K/min, {hold} min" + (
        ", pore closure" if closing else ""
    )
    return what, powder(f"cell {number}: {what}", material, particles, mean, spread, ratio) + f"""[specimen]
shape = "periodic"
[specimen.packing]
green_density = {rng.choice([0.58, 0.60, 0.62])}
seed = {number + 1}
[specimen.perturbation]
size = 1e-3
{CONTACT}{"[contact.sintering.pore_closure]" if closing else ""}
{stages}"""


def scene(rng, number):
    material = rng.choice(["NiAl", "NiAl", "Cu", "Al2O3"])
    particles = rng.choice([100, 150, 200, 300, 400])
    ratio = rng.choice([1.0, 2.0, 4.0])
    mean = rng.choice([4.0, 8.0, 15.0])
    pressure = rng.choice([3, 8, 15, 30, 45])
    peak = rng.randint(*HEAT[material])
    rate = rng.choice([5, 15, 40])
    hold = rng.choice([5, 15, 40])
    green = rng.choice([0.52, 0.54, 0.56])
    solid = particles * mean**3 * 0.5236 * (1.0 if ratio == 1 else 1.35)
    diameter = (solid / green * 4 / 3.14159 / rng.choice([0.8, 1.2])) ** (1 / 3)
    shape = rng.choice(["cylinder", "cylinder", "box"])
    friction = rng.random() < 0.2
    spread = {1.0: 0.05, 2.0: 0.2, 4.0: 0.35}[ratio] * mean
    size = f'diameter = "{diameter:.5g} um"' if shape == "cylinder" else f'size = ["{diameter:.5g} um", "{diameter:.5g} um"]'
    what = f"{material}, {particles} in a {shape}, {pressure} MPa, {peak} degC, {rate} K/min, {hold} min" + (
        ", friction" if friction else ""
    )
    rub = "[contact.friction]\ncoefficient = 0.3\n" if friction else ""
    unloading = '[[process.stage]]\nname = "unloading"\nduration = "20 min"\npressure = "0 MPa"\n'
    stages = process(f'pressure = "{pressure} MPa"', peak, rate, hold, unloading)
    return what, powder(f"scene {number}: {what}", material, particles, mean, spread, ratio) + f"""[specimen]
shape = "{shape}"
{size}
[specimen.packing]
green_density = {green}
seed = {number + 1}
[specimen.perturbation]
size = 1e-3
{CONTACT}{rub}{stages}"""


def ends_of_stages(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    ends = {}
    for row in rows:
        ends[row["stage"]] = row
    return ends


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", type=int, default=24)
    parser.add_argument("--accuracy", default="standard")
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--cells", action="store_true")
    parser.add_argument("--program", default=str(ROOT / "densify"))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    rng = random.Random(given.seed)
    rows = []
    for number in range(given.scenes):
        what, text = (cell if given.cells else scene)(rng, number)
        folder = given.out / f"scene_{number:02d}"
        folder.mkdir(exist_ok=True)
        (folder / "scene.toml").write_text(text)
        cases = {
            "converged": ["realisations=8", "integration.accuracy=3.3e-4"],
            given.accuracy: [f"integration.accuracy={given.accuracy}", "specimen.perturbation.seed=1000"],
        }
        failed = None
        for name, settings in cases.items():
            if (folder / name / "history.csv").exists():
                continue
            command = shlex.split(given.program) + ["run", str(folder / "scene.toml"), "--quiet", "--out", str(folder / name)]
            for setting in settings:
                command += ["--set", setting]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                failed = f"{name}: {done.stderr.strip().splitlines()[-1]}"
                break
        if failed:
            print(f"{number:2d} {what}: {failed}", flush=True)
            continue
        converged = ends_of_stages(folder / "converged" / "history.csv")
        judged = ends_of_stages(folder / given.accuracy / "history.csv")
        true = estimate = where = None
        for stage, row in judged.items():
            error = abs(float(row["relative_density"]) - float(converged[stage]["relative_density"]))
            if true is None or error > true:
                true, estimate, where = error, float(row["relative_density_error"]), stage
        noise = float(converged[where]["relative_density_standard_error"])
        last = list(judged.values())[-1]
        rows.append((true, estimate))
        print(
            f"| {number} | {what} | {float(last['relative_density']):.4f} | {last['steps']} | {true:.4f} | {noise:.4f} |"
            f" {where} | {estimate:.4f} | {estimate / true:.2f} |",
            flush=True,
        )
    if not rows:
        return 1
    below = sum(t <= e for t, e in rows)
    print(f"true error below its estimate in {below} of {len(rows)}; median true {statistics.median(t for t, _ in rows):.4f},"
          f" median estimate {statistics.median(e for _, e in rows):.4f}, median of estimate over true"
          f" {statistics.median(e / t for t, e in rows):.2f}")


if __name__ == "__main__":
    sys.exit(main())
