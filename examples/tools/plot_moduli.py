#!/usr/bin/env python3
"""Draw what `densify compare-moduli` found: moduli over relative density by every route, with curves and measurements.

    plot_moduli.py DIR/comparison.csv [-o FOLDER]

Reads curves.csv beside the table.  Writes comparison.png and comparison.svg: Young's modulus, Poisson's ratio and, where
strengths were measured, strength.  Every result has its own marker, every route its own colour.  Needs matplotlib.
"""

import argparse
import csv
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

GIGA, MEGA = 1e-9, 1e-6
ROUTES = {  # colours that differ for all eyes (Okabe and Ito)
    "normal_spring": ("#999999", "normal springs"),
    "bonded_neck": ("#0072b2", "bonded necks"),
    "neck_beam": ("#56b4e9", "neck beams"),
    "series": ("#009e73", "constriction and body"),
    "voxels": ("#d55e00", "voxel elements"),
    "measured": ("black", "measured"),
}
MARKERS = "osD^vP*X"
CURVES = {  # style, label, Young's modulus, Poisson's ratio
    "solid_spheres": ("-", "Roberts-Garboczi, solid spheres"),
    "spherical_pores": ("--", "Roberts-Garboczi, spherical pores"),
}


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [{k: v if k in ("result", "route") else float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def column(rows, name, scale=1.0):
    return [scale * row[name] for row in rows]


def draw_curves(modulus, poisson, curves):
    """Those of every solid; results of the same solid share them."""
    drawn = set()
    for result in dict.fromkeys(row["result"] for row in curves):
        rows = [row for row in curves if row["result"] == result]
        solid = f"{rows[-1]['solid_spheres_youngs_modulus_Pa']:.4e}"
        if solid in drawn:
            continue
        density = column(rows, "relative_density")
        for name, (style, label) in CURVES.items():
            label = None if drawn else label
            modulus.plot(density, column(rows, name + "_youngs_modulus_Pa", GIGA), style, color="0.25", lw=1, label=label)
            poisson.plot(density, column(rows, name + "_poissons_ratio"), style, color="0.25", lw=1)
        modulus.plot(density, column(rows, "hashin_shtrikman_upper_youngs_modulus_Pa", GIGA), ":", color="0.5", lw=1,
                     label=None if drawn else "Hashin-Shtrikman, upper")
        modulus.plot(density, column(rows, "voigt_youngs_modulus_Pa", GIGA), "-.", color="0.7", lw=1,
                     label=None if drawn else "Voigt")
        low, high = (rows[-1][f"dense_{m}_youngs_modulus_Pa"] * GIGA for m in ("reuss", "voigt"))
        if high > 1.001 * low:  # a composite: where the dense body may lie
            modulus.errorbar([1], [(low + high) / 2], yerr=(high - low) / 2, color="0.7", capsize=3, lw=1)
            low, high = (rows[-1][f"dense_hashin_shtrikman_{b}_youngs_modulus_Pa"] * GIGA for b in ("lower", "upper"))
            modulus.errorbar([1], [(low + high) / 2], yerr=(high - low) / 2, color="0.4", lw=3)
        drawn.add(solid)


def draw_routes(modulus, poisson, table):
    results = [r for r in dict.fromkeys(row["result"] for row in table) if r != "measured"]
    for route, (colour, label) in ROUTES.items():
        for result in dict.fromkeys(row["result"] for row in table if row["route"] == route):
            rows = [row for row in table if row["route"] == route and row["result"] == result]
            marker = "x" if route == "measured" else MARKERS[results.index(result) % len(MARKERS)]
            style = dict(color=colour, marker=marker, ms=4, lw=0 if route == "measured" else 0.9, mew=0.9,
                         mfc="white" if route not in ("voxels", "measured") else colour, capsize=2)
            named = label if len(results) < 2 or route == "measured" else f"{label}, {result}"
            for axes, name, scale in ((modulus, "youngs_modulus", GIGA), (poisson, "poissons_ratio", 1.0)):
                unit = "_Pa" if name == "youngs_modulus" else ""
                error = column(rows, f"{name}_error{unit}", scale)
                axes.errorbar(column(rows, "relative_density"), column(rows, name + unit, scale),
                              yerr=error if route == "voxels" and all(map(math.isfinite, error)) else None,
                              label=named, zorder=4 if route == "measured" else 3, **style)


def draw_strength(axes, table, curves):
    rows = [row for row in table if row["route"] == "measured"]
    axes.plot(column(rows, "relative_density"), column(rows, "strength_Pa", MEGA), "x", color="black", ms=4)
    first = [row for row in curves if row["result"] == curves[0]["result"]]
    axes.plot(column(first, "relative_density"), column(first, "ryshkewitch_strength_Pa", MEGA), "-", color="0.25", lw=1,
              label="Ryshkewitch")
    axes.set_ylabel("strength [MPa]")
    axes.legend(frameon=False, fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", metavar="CSV", help="comparison.csv of densify compare-moduli")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="folder of the pictures, without it that of the table")
    options = parser.parse_args()
    path = pathlib.Path(options.table)
    folder = pathlib.Path(options.output or path.parent)
    table, curves = read(path), read(path.parent / "curves.csv")
    strengths = any(math.isfinite(row["strength_Pa"]) for row in table)
    plt.rcParams.update({"font.size": 8, "axes.labelsize": 9, "svg.fonttype": "none"})
    panels = 3 if strengths else 2
    figure, axes = plt.subplots(1, panels, figsize=(3.6 * panels, 3.0))
    draw_curves(axes[0], axes[1], curves)
    draw_routes(axes[0], axes[1], table)
    axes[0].set_ylabel("Young's modulus [GPa]")
    axes[1].set_ylabel("Poisson's ratio")
    if strengths:
        draw_strength(axes[2], table, curves)
    first = min(row["relative_density"] for row in table)
    for panel, letter in zip(axes, "abc"):
        panel.set_xlim(max(0.5, math.floor(20 * first - 0.2) / 20), 1.005)
        panel.set_xlabel("relative density")
        panel.set_title(letter, loc="left", fontweight="bold", fontsize=9)
        panel.tick_params(direction="in", top=True, right=True)
    axes[0].set_ylim(bottom=0)
    seen = [row["poissons_ratio"] for row in table if math.isfinite(row["poissons_ratio"])]
    if seen:
        axes[1].set_ylim(max(min(seen) - 0.05, -0.2), min(max(seen) + 0.05, 0.5))
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3, frameon=False, fontsize=7.5)
    rows = math.ceil(len(labels) / 3)
    height = 3.0 + 0.15 * rows  # [in], the legend below the panels
    figure.set_size_inches(3.6 * panels, height)
    figure.tight_layout(rect=(0, 0.15 * rows / height, 1, 1))
    for suffix in (".png", ".svg"):
        figure.savefig(folder / (path.stem + suffix), dpi=200)


if __name__ == "__main__":
    main()
