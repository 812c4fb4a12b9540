#!/usr/bin/env python3
"""How large must a periodic cell be: scatter and bias of its properties over the number of particles.

    measure_rve_size.py SCENE --out DIR [--sizes 200:12 600:8 ...] [--density 0.85 0.95] [--set KEY=VALUE ...]

Runs the scene with every number of particles for as many packings (specimen.packing.seed) as stand behind the colon, takes
the properties that `densify moduli` finds (contact model bonded_neck) at the relative densities, linear in their logarithm
between the two nearest snapshots, and prints for every size mean, standard deviation of one cell and bias against the
largest size, with standard errors, then the size that one cell needs for a scatter of 5, 2 and 1 %.  Rows that
cells.csv in DIR holds are not run again.  Needs numpy and h5py.
"""

import argparse
import csv
import math
import pathlib
import resource
import shutil
import subprocess
import sys

import h5py

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PROPERTIES = {  # name: table, column
    "E": ("moduli", "youngs_modulus_Pa"),
    "K": ("moduli", "bulk_modulus_Pa"),
    "G": ("moduli", "shear_modulus_Pa"),
    "bulk viscosity": ("viscosities", "bulk_viscosity_Pa_s"),
    "shear viscosity": ("viscosities", "shear_viscosity_Pa_s"),
    "sintering stress": ("viscosities", "sintering_stress_Pa"),
}
FIELDS = ["particles", "seed", "density", *PROPERTIES, "cpu_s"]


def run(command):
    """User time of a command [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def around(result, density):
    """Times [s] of the last snapshot below the density and of the one after it."""
    with h5py.File(result, "r") as file:
        moments = [(s.attrs["time"], s.attrs["relative_density"])
                   for _, s in sorted(file["snapshots"].items())]
    for (t0, low), (t1, high) in zip(moments, moments[1:]):
        if low < density <= high:
            return t0, t1
    sys.exit(f"{result}: relative density {density} is not among its snapshots")


def cell(options, particles, seed, out):
    """Rows of one cell, a row a density."""
    folder = out / f"{particles}_{seed}"
    shutil.rmtree(folder, ignore_errors=True)
    settings = [f"powder.1.number={particles}", f"specimen.packing.seed={seed}", *options.set]
    cpu = run([options.program, "run", options.scene, "--out", folder, "--quiet",
               *(word for s in settings for word in ("--set", s))])
    rows = []
    for density in options.density:
        times = around(folder / "result.h5", density)
        run([options.program, "moduli", folder, "--quiet", "--model", "bonded_neck", "--out", folder / "at",
             *(word for t in times for word in ("--at-time", f"{t:.17g} s"))])
        tables = {name: read(folder / "at" / f"{name}.csv") for name in ("moduli", "viscosities")}
        row = {"particles": particles, "seed": seed, "density": density, "cpu_s": f"{cpu:.2f}"}
        for name, (table, column) in PROPERTIES.items():
            low, high = ((float(r["relative_density"]), float(r[column])) for r in tables[table])
            share = (density - low[0]) / (high[0] - low[0])
            row[name] = f"{low[1] ** (1 - share) * high[1] ** share:.6g}"
        rows.append(row)
    shutil.rmtree(folder)
    return rows


def statistics(rows, name):
    """Mean, relative standard deviation (nan of one value) and number of what the rows say of a property."""
    values = [float(r[name]) for r in rows if r.get(name)]
    n = len(values)
    if n == 0:
        return math.nan, math.nan, 0
    mean = sum(values) / n
    return mean, math.sqrt(sum((v / mean - 1) ** 2 for v in values) / (n - 1)) if n > 1 else math.nan, n


def report(rows):
    for density in sorted({float(r["density"]) for r in rows}):
        here = [r for r in rows if float(r["density"]) == density]
        sizes = sorted({int(r["particles"]) for r in here})
        found = {(size, name): statistics([r for r in here if int(r["particles"]) == size], name)
                 for size in sizes for name in (*PROPERTIES, "cpu_s")}
        scatter = {}  # c of c / sqrt(particles): c^2 from all sizes, each weighted with its degrees of freedom
        for name in PROPERTIES:
            terms = [(found[size, name][1] ** 2 * size, found[size, name][2] - 1) for size in sizes
                     if found[size, name][2] > 1]
            if terms:
                scatter[name] = math.sqrt(sum(t * w for t, w in terms) / sum(w for _, w in terms))
        print(f"\nrelative density {density}: standard deviation of one cell; bias against the largest cells [%]")
        print("| particles | cells | CPU [s] | " + " | ".join(PROPERTIES) + " |")
        print("|---" * (3 + len(PROPERTIES)) + "|")
        for size in sizes:
            cpu, _, cells = found[size, "cpu_s"]
            texts = []
            for name in PROPERTIES:
                mean, spread, n = found[size, name]
                largest = max((s for s in sizes if found[s, name][2] > 0), default=size)
                best, _, best_n = found[largest, name]
                text = "" if n < 2 else f"{100 * spread:.1f}"
                if 0 < n and size < largest:
                    error = scatter.get(name, math.nan) * math.sqrt(1 / (n * size) + 1 / (best_n * largest))
                    text += f"; {100 * (mean / best - 1):+.1f} ± {100 * error:.1f}"
                texts.append(text)
            print(f"| {size} | {cells} | {cpu:.3g} | " + " | ".join(texts) + " |")
        print("scatter of one cell, c / sqrt(particles), and the particles for 5, 2, 1 % (standard deviation):")
        for name, c in scatter.items():
            print(f"  {name:<17s} c = {c:.2f}: " + ", ".join(f"{(c / p) ** 2:.0f}" for p in (0.05, 0.02, 0.01)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--out", required=True)
    parser.add_argument("--sizes", nargs="+", default=["200:12", "600:8", "2000:6", "6000:4", "20000:3"])
    parser.add_argument("--density", nargs="+", type=float, default=[0.85, 0.95])
    parser.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", help="settings of the scene")
    parser.add_argument("--program", default=ROOT / "densify")
    options = parser.parse_args()
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    table = out / "cells.csv"
    rows = read(table) if table.exists() else []
    for size in options.sizes:
        particles, seeds = (int(part) for part in size.split(":"))
        for seed in range(1, seeds + 1):
            if any(int(r["particles"]) == particles and int(r["seed"]) == seed for r in rows):
                continue
            rows += cell(options, particles, seed, out)
            with open(table, "w", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, FIELDS)
                writer.writeheader()
                writer.writerows(rows)
    report(rows)


if __name__ == "__main__":
    main()
