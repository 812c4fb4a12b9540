#!/usr/bin/env python3
"""Plot relative density and temperature over process time for one or several runs, with measured points.

    plot_density.py results/hot_press [MORE...] [--labels TEXT...] [--measured measured.csv] -o density.png

The measured points are a CSV file with the columns time_s and relative_density; lines that start with # are comments.
Needs numpy, h5py and matplotlib.
"""

import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from densify_results import Results


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", metavar="DIR", help="results folder of a run")
    parser.add_argument("--labels", nargs="+", metavar="TEXT", help="one a folder; without it the folders' names")
    parser.add_argument("--measured", metavar="CSV", help="measured points: columns time_s, relative_density")
    parser.add_argument("-o", "--output", required=True, metavar="PNG", help="picture to write")
    options = parser.parse_args()

    figure, density = plt.subplots(figsize=(7, 4.5), constrained_layout=True)
    temperature = density.twinx()
    labels = options.labels or [pathlib.Path(folder).resolve().name for folder in options.folders]
    if len(labels) != len(options.folders):
        parser.error(f"{len(options.folders)} folders need as many labels")
    for folder, label in zip(options.folders, labels):
        history = Results(folder).history
        minutes = history["time_s"] / 60
        density.plot(minutes, history["relative_density"], label=label)
        temperature.plot(minutes, history["temperature_K"] - 273.15, color="0.6", linewidth=1, linestyle="--")
    if options.measured:
        with open(options.measured, encoding="utf-8") as file:
            lines = [line for line in file if not line.startswith("#")]
        points = np.genfromtxt(lines, delimiter=",", names=True)
        density.plot(points["time_s"] / 60, points["relative_density"], "ko", markerfacecolor="none", label="measured")
    density.set_xlabel("time [min]")
    density.set_ylabel("relative density")
    temperature.set_ylabel("temperature [°C] (dashed)")
    density.set_zorder(temperature.get_zorder() + 1)  # curves and legend above the temperature
    density.patch.set_visible(False)
    density.legend(loc="lower right")
    density.grid(alpha=0.3)
    figure.savefig(options.output, dpi=110)


if __name__ == "__main__":
    main()
