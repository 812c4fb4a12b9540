#!/usr/bin/env python3
"""Hot press the composite by both readings of the sintering contact, and set its stresses beside the thesis's.

    compare.py [--again] [--packings N]

Runs each reading for N packings (default 4) with ./densify into results/hot_press_composite/CASE, unless their results
are there from an earlier call, has ./densify stresses make the tables, and prints those of README.md: mean over the
packings and standard deviation of one.  Needs numpy and h5py, and matplotlib for the pictures.
"""

import argparse
import csv
import pathlib
import subprocess
import sys

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "results" / "hot_press_composite"
sys.path.insert(0, str(HERE.parent / "tools"))
from cases import build, run_case  # noqa: E402

SECOND = ["contact.sintering.radius=smaller", "contact.sintering.neck=overlap", "contact.hertz_radius=reduced"]
READINGS = {"text": [], "second": SECOND}
LOADED, HOLD, COOLED, END = "loading", "hold to 30 min", "cooling", "unloading"
MOMENTS = ["heating to 1300 degC", "heating to 1350 degC", "heating to 1400 degC", "hold to 10 min", HOLD]
# Thesis Tables 5.8 (measured), 6.1, 6.2 and 6.3 [MPa].
MEASURED = [0.90, 0.95, 0.95, 0.97, 1.00]
MACROSCOPIC = {"xx": (1.8, -6.1, -4.3, -0.00006), "yy": (1.8, -6.3, -4.5, -0.000001), "zz": (1.5, -31.1, -29.6, -0.000075)}
EXTREMES = {"maximum": (0.2, 452.6, 532.3, 540.6), "minimum": (-463.4, -1861.6, -2292.3, -2201.2)}
PHASES = {"mean": (-10.3, -16.1, 1.9, -25.3), "standard_deviation": (51.6, 95.7, 53.6, 110.6),
          "maximum": (374.2, 452.6, 540.6, 387.4), "minimum": (-814.3, -1861.6, -806.5, -2201.2)}


class Packing:
    """The tables of one run; of the moments of a stage the last counts, its end."""

    def __init__(self, folder):
        self.tables = {}
        for name in ("macroscopic_stress", "particle_stress", "neck_stress"):
            with open(folder / f"{name}.csv", encoding="utf-8", newline="") as file:
                self.tables[name] = list(csv.DictReader(file))
        with h5py.File(folder / "stresses.h5") as file:
            times = [float(row["time_s"]) for row in self.tables["macroscopic_stress"] if row["by"] == "specimen"]
            hold = [float(row["time_s"]) for row in self.tables["macroscopic_stress"] if row["stage"] == HOLD][-1]
            necks = file[f"moments/{times.index(hold):06}/necks"]
            self.sintering = necks["sintering_stress"][()][necks["at_equilibrium"][()] == 0] * 1e-6

    def value(self, table, column, stage, **keys):
        rows = [row for row in self.tables[table] if row["stage"] == stage and all(row[k] == v for k, v in keys.items())]
        return float(rows[-1][column])

    def macroscopic(self, stage, column):
        return self.value("macroscopic_stress", f"{column}_Pa", stage, by="specimen") * 1e-6

    def particles(self, stage, of, column):
        return self.value("particle_stress", f"{column}_Pa", stage, stress="total mean", of=of) * 1e-6


def run(reading, packing, again):
    folder = RESULTS / f"{reading}_{packing}"
    run_case(HERE, folder, READINGS[reading] + [f"specimen.packing.seed={packing}"], again)
    if again or not (folder / "stresses.h5").exists():
        subprocess.run([ROOT / "densify", "stresses", folder, "--quiet"], check=True)
    return Packing(folder)


def line(label, thesis, packings, values, digits):
    """One row: the thesis, then mean and standard deviation of each reading; `values` maps a packing to numbers."""
    cells = [f"| {label} |"]
    for k, number in enumerate(thesis):
        cells.append(f" {number:g} |")
        for reading in READINGS:
            sample = [values(p)[k] for p in packings[reading]]
            cells.append(f" {np.mean(sample):.{digits}f} ± {np.std(sample, ddof=1):.{digits}f} |")
    print("".join(cells))


def head(label, columns):
    print("\n| " + label + " |" + "".join(f" {c}: thesis | text | second |" for c in columns))
    print("|---" * (1 + 3 * len(columns)) + "|")


def print_tables(packings):
    head("relative density", ["measured"])
    for stage, number in zip(MOMENTS, MEASURED):
        line(stage, [number], packings, lambda p: [p.value("macroscopic_stress", "relative_density", stage, by="specimen")], 3)
    head("macroscopic stress [MPa]", ["sintering", "viscoelastic", "total", "residual"])
    for direction, thesis in MACROSCOPIC.items():
        line(direction, thesis, packings,
             lambda p: [p.macroscopic(HOLD, f"{part}_{direction}") for part in ("sintering", "viscoelastic", "total")] +
             [p.macroscopic(END, f"total_{direction}")], 2)
    head("particles [MPa]", ["loaded", "hold", "cooled", "unloaded"])
    for column, thesis in EXTREMES.items():
        line(column, thesis, packings, lambda p: [p.particles(s, "all", column) for s in (LOADED, HOLD, COOLED, END)], 0)
    head("particles by phase [MPa]", ["hold, NiAl", "hold, Al2O3", "end, NiAl", "end, Al2O3"])
    for column, thesis in PHASES.items():
        line(column.replace("_", " "), thesis, packings,
             lambda p: [p.particles(s, of, column) for s in (HOLD, END) for of in ("NiAl", "Al2O3")],
             1 if column in ("mean", "standard_deviation") else 0)
    print("\nsintering stress in necks short of equilibrium, end of the hold [MPa]; unlike necks have none")
    for reading, all_packings in packings.items():
        stress = np.concatenate([p.sintering for p in all_packings])
        share = np.mean((stress >= 0) & (stress <= 10))
        driven = stress[stress > 0]
        print(f"{reading}: median {np.median(driven):.2f} of those that have some, {100 * share:.1f} % of all from 0 to 10, "
              f"largest {stress.max():.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--again", action="store_true", help="run everything again")
    parser.add_argument("--packings", type=int, default=4, metavar="N")
    options = parser.parse_args()
    build()
    packings = {r: [run(r, k + 1, options.again) for k in range(options.packings)] for r in READINGS}
    print_tables(packings)


if __name__ == "__main__":
    main()
