#!/usr/bin/env python3
"""Plot processor time against density error of a ladder, from the trade.csv of `densify trade`.

    plot_trade.py DIR/trade.csv [-o DIR/trade]

Writes the picture as .png and .svg.  Bars are two standard errors; the line joins the Pareto front.  The converged rung
stands as a band: twice the standard error of its mean, below which this ladder can show nothing.
Needs matplotlib.
"""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", metavar="CSV", help="trade.csv of a ladder")
    parser.add_argument("-o", "--output", metavar="NAME", help="picture to write, without .png")
    options = parser.parse_args()
    output = pathlib.Path(options.output or pathlib.Path(options.table).with_suffix(""))

    with open(options.table, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if not row["failure"]]
    points = []
    floor = 0
    for row in rows:
        error, noise = float(row["error_relative_density"]), float(row["error_relative_density_standard_error"])
        if error == 0 and noise == 0:  # the converged rung, against itself
            floor = 2 * float(row["spread_of_one_realisation"]) / float(row["realisations"]) ** 0.5
            converged = (float(row["cpu_s"]), row["rung"])
            continue
        points.append((float(row["cpu_s"]), error, noise, row["rung"]))

    figure, axes = plt.subplots(figsize=(7.5, 5), constrained_layout=True)
    smallest = 1e-9  # what a logarithm can show of an error of nothing
    points = [(time, max(error, smallest), noise, name) for time, error, noise, name in points]
    lowest = 0.5 * min([error for _, error, _, _ in points] + ([floor] if floor > smallest else []))
    for time, error, noise, name in points:
        below = error - max(error - 2 * noise, lowest)
        axes.errorbar(time, error, yerr=[[below], [2 * noise]], fmt="o", capsize=3)
        axes.annotate(name, (time, error), textcoords="offset points", xytext=(6, 4), fontsize=8)
    front, best = [], float("inf")
    for time, error, _, _ in sorted(points):
        if error < best:
            front.append((time, error))
            best = error
    axes.plot(*zip(*front), "-", color="0.6", zorder=0, label="Pareto front")
    if floor > smallest:
        axes.axhspan(lowest, floor, color="0.9", zorder=-1, label="twice the standard error of the converged mean")
        axes.plot(converged[0], floor, "k*", label=f"converged: {converged[1]}")
    for target in (1e-2, 3e-3, 1e-3):
        axes.axhline(target, color="0.8", linewidth=0.8, linestyle=":")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("processor time of one realisation [s]")
    axes.set_ylabel("largest error of the mean relative density")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=3, frameon=False)
    axes.grid(alpha=0.3, which="both")
    for suffix in (".png", ".svg"):
        figure.savefig(output.with_name(output.name + suffix), dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main()
