#!/usr/bin/env python3
"""Density of body-centred cubic copper while it sinters: a block against one pair and (5.3) (thesis Fig. 5.8).

    compare.py [--again]

Runs the block (for a short while also at mass factor 1e14) and the pair with ./densify into results/bcc_copper/CASE,
unless their results are there from an earlier call, prints the table of README.md and draws density.png.  Needs numpy,
h5py and matplotlib.
"""

import argparse
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE.parents[1] / "results" / "bcc_copper"
sys.path.insert(0, str(HERE.parent / "tools"))
from cases import build, run_case  # noqa: E402
from densify_results import Results  # noqa: E402

RADIUS, CELLS = 22.5e-6, 5
EDGE = 4 * RADIUS / math.sqrt(3) * (1 - 1e-6)  # of bcc.py [m]
BCC = math.pi * math.sqrt(3) / 8  # relative density of touching spheres
LONG, SHORT = "process.stage.1.duration=3e5 s", "process.stage.1.duration=1e4 s"
CASES = {
    "block": (HERE / "scene.toml", [LONG, "output.history_interval=250 s"]),
    "light_block": (HERE / "scene.toml", [SHORT, "output.history_interval=50 s", "integration.mass_scaling=1e14"]),
    "pair": (HERE.parent / "two_copper_spheres" / "scene.toml", [LONG, "output.history_interval=250 s"]),
}


def curve(name):
    """Times [s], linear strain and spread of the strain over the three directions."""
    history = Results(RESULTS / name).history
    if name == "pair":
        strain = 2 * (history["shrinkage_x"] - 1)  # of the distance of centres, the box being twice as long
        return history["time_s"], strain, 0 * strain
    box = CELLS * EDGE + 2 * RADIUS  # the corners of the lattice and the radii of the outermost spheres
    sides = np.array([(history[f"shrinkage_{c}"] * box - 2 * RADIUS) / (CELLS * EDGE) - 1 for c in "xyz"])
    return history["time_s"], sides.mean(axis=0), np.ptp(sides, axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--again", action="store_true", help="run all again")
    options = parser.parse_args()
    build()
    costs = {name: run_case(scene, RESULTS / name, settings, options.again)
             for name, (scene, settings) in CASES.items()}
    (t_pair, e_pair, _), (t_block, e_block, spread) = curve("pair"), curve("block")
    t_light, e_light, _ = curve("light_block")
    box_density = Results(RESULTS / "block").history["relative_density"]

    print("| time [s] | strain of the pair | (5.3) | strain of the block | its density | at mass factor 1e14 "
          "| box of all spheres |")
    print("|---" * 7 + "|")
    for time in (1e3, 3e3, 1e4, 3e4, 1e5, 2e5, 3e5):
        pair, block, box = (np.interp(time, t, e) for t, e in ((t_pair, e_pair), (t_block, e_block),
                                                              (t_block, box_density)))
        light = f"{BCC / (1 + np.interp(time, t_light, e_light))**3:.4f}" if time <= t_light[-1] else "-"
        print(f"| {time:.0e} | {pair:.5f} | {BCC / (1 + pair)**3:.4f} | {block:.5f} | {BCC / (1 + block)**3:.4f} "
              f"| {light} | {box:.4f} |")
    print(f"largest difference of the block's strain over x, y, z: {spread.max():.0e}")
    for name, cost in costs.items():
        print(f"{name}: {cost['steps']} steps, {cost['seconds']:.1f} s of user time")

    figure, axis = plt.subplots(figsize=(7, 4.2), constrained_layout=True)
    hours = 3600
    axis.plot(t_block / hours, BCC / (1 + e_block)**3, "C0-", linewidth=2.5, alpha=0.6,
              label=f"block of {CELLS} x {CELLS} x {CELLS} cells")
    axis.plot(t_pair / hours, BCC / (1 + e_pair)**3, "k--", linewidth=1.2, label="one pair and (5.3)")
    axis.plot(t_block / hours, box_density, "C3:", label="the block with its ragged surface: box of all spheres")
    axis.axhline(1, color="0.6", linewidth=1)
    axis.set_xlabel("time [h]")
    axis.set_ylabel("relative density")
    axis.grid(alpha=0.3)
    axis.legend()
    (HERE / "pictures").mkdir(exist_ok=True)
    figure.savefig(HERE / "pictures" / "density.png", dpi=110)


if __name__ == "__main__":
    main()
