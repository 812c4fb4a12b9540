#!/usr/bin/env python3
"""Draw what `densify stresses` found: histograms of the stress in particles and necks, and its course in the specimen.

    plot_stresses.py DIR/stress_histograms.csv [-o FOLDER] [--history history.csv]

Writes particle_stress, neck_stress (where there are necks), phase_stress (of several materials at three moments or more,
from macroscopic_stress.csv beside the table) and, with a history, macroscopic_stress, each as .png and .svg.  Histograms have
one row a moment, at most six; their bins hold all but the outermost values, whose numbers stand in the corners.
Needs matplotlib.
"""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MEGA = 1e-6
MOST_ROWS = 6
COLOURS = {"sintering": "#d1802f", "viscoelastic": "#3b6ea5", "total": "#333333"}


def read_histograms(path):
    """Counts by (time, stage), (where, stress, set, of): lists of (low, high, count)."""
    moments = {}
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            moment = moments.setdefault((float(row["time_s"]), row["stage"]), {})
            bars = moment.setdefault((row["where"], row["stress"], row["set"], row["of"]), [])
            bars.append((MEGA * float(row["low_Pa"]), MEGA * float(row["high_Pa"]), float(row["count"])))
    return moments


def chosen(moments):
    """At most MOST_ROWS moments, evenly spread, the last among them."""
    times = sorted(moments)
    if len(times) > MOST_ROWS:
        times = [times[round(k * (len(times) - 1) / (MOST_ROWS - 1))] for k in range(MOST_ROWS)]
    return times


def bars(axes, histogram, **style):
    inside = histogram[1:-1]
    edges = [low for low, _, _ in inside] + [inside[-1][1]]
    axes.stairs([count for _, _, count in inside], edges, **style)


def tails(axes, histogram):
    """How many values lie beyond the bins, in the upper corners."""
    for place, side, count in ((0.02, "left", histogram[0][2]), (0.98, "right", histogram[-1][2])):
        if count:
            text = f"{count:.0f} below" if side == "left" else f"{count:.0f} above"
            axes.text(place, 0.95, text, transform=axes.transAxes, ha=side, va="top", fontsize=7, color="0.35")


def figure_of(rows, columns):
    figure, axes = plt.subplots(rows, columns, figsize=(3.4 * columns + 0.6, 2.1 * rows + 0.6), squeeze=False,
                                sharex="col", constrained_layout=True)
    for row in axes:
        for panel in row:
            panel.axvline(0, color="0.7", linewidth=0.8)
            panel.tick_params(labelsize=8)
    return figure, axes


def finish(axes):
    """One scale for all panels, so that rows and columns can be compared."""
    top = max(panel.dataLim.y1 for row in axes for panel in row)
    for row in axes:
        for panel in row:
            panel.set_yscale("log")
            panel.set_ylim(0.7, 3 * top)
            panel.label_outer()


def name_row(panel, moment, what):
    time, stage = moment
    panel.set_ylabel(f"{what}\n{time / 60:.0f} min, {stage}", fontsize=8)


def save(figure, folder, name):
    for suffix in (".png", ".svg"):
        figure.savefig(folder / (name + suffix), dpi=110)
    plt.close(figure)


def draw_particles(moments, folder):
    groups = []
    for moment in moments.values():
        for where, stress, _, of in moment:
            if where == "particles" and stress == "total mean" and of not in groups:
                groups.append(of)
    times = chosen(moments)
    figure, axes = figure_of(len(times), len(groups))
    for row, moment in zip(axes, times):
        for panel, group in zip(row, groups):
            histogram = moments[moment][("particles", "total mean", "all", group)]
            bars(panel, histogram, fill=True, color=COLOURS["viscoelastic"])
            tails(panel, histogram)
        name_row(row[0], moment, "particles")
    for panel, group in zip(axes[0], groups):
        panel.set_title(group, fontsize=10)
    for panel in axes[-1]:
        panel.set_xlabel("mean stress in a particle [MPa]", fontsize=8)
    finish(axes)
    save(figure, folder, "particle_stress")


def draw_necks(moments, folder):
    moments = {key: m for key, m in moments.items() if any(where == "necks" for where, _, _, _ in m)}
    if not moments:
        return
    times = chosen(moments)
    figure, axes = figure_of(len(times), len(COLOURS))
    for row, moment in zip(axes, times):
        for panel, (stress, colour) in zip(row, COLOURS.items()):
            of_stress = {key[2:]: h for key, h in moments[moment].items() if key[:2] == ("necks", stress)}
            whole = "all" if ("all", "all") in of_stress else next(of for which, of in of_stress if which == "all")
            histogram = of_stress[("all", whole)]
            bars(panel, of_stress[("short of equilibrium", whole)], fill=True, color=colour, alpha=0.75)
            bars(panel, histogram, color="k", linewidth=0.8)
            tails(panel, histogram)
        name_row(row[0], moment, "necks")
    for panel, stress in zip(axes[0], COLOURS):
        panel.set_title({"sintering": "sintering driving"}.get(stress, stress), fontsize=10)
    for panel in axes[-1]:
        panel.set_xlabel("stress in a neck [MPa]", fontsize=8)
    figure.suptitle("outline: all necks; filled: those short of equilibrium", fontsize=9)
    finish(axes)
    save(figure, folder, "neck_stress")


def three_directions(what):
    """A panel each for xx, yy and zz over time."""
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), sharey=True, constrained_layout=True)
    for panel, direction in zip(axes, ("xx", "yy", "zz")):
        panel.axhline(0, color="0.7", linewidth=0.8)
        panel.set_title(direction, fontsize=10)
        panel.set_xlabel("time [min]")
        panel.grid(alpha=0.3)
    axes[0].set_ylabel(f"{what} [MPa]")
    return figure, axes


def draw_phases(path, folder):
    """The mean stress in each material over time: its part of the specimen's stress over its share of the volume."""
    phases = {}
    if path.exists():
        with open(path, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["by"] == "particles":
                    phases.setdefault(row["of"], []).append(row)
    if len(phases) < 2 or min(len(rows) for rows in phases.values()) < 3:
        return
    figure, axes = three_directions("mean stress in the phase")
    for panel, direction in zip(axes, ("xx", "yy", "zz")):
        for name, rows in phases.items():
            rows = sorted(rows, key=lambda row: float(row["time_s"]))
            panel.plot([float(row["time_s"]) / 60 for row in rows],
                       [MEGA * float(row[f"total_{direction}_Pa"]) / float(row["volume_share"]) for row in rows],
                       linewidth=1.2, marker=".", markersize=3, label=name)
    axes[0].legend(frameon=False, fontsize=8)
    save(figure, folder, "phase_stress")


def draw_course(path, folder):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or "sintering_stress_xx_Pa" not in rows[0]:
        return
    minutes = [float(row["time_s"]) / 60 for row in rows]
    figure, axes = three_directions("macroscopic stress")
    columns = {"sintering": "sintering_stress_", "viscoelastic": "viscoelastic_stress_", "total": "stress_"}
    for panel, direction in zip(axes, ("xx", "yy", "zz")):
        for stress, column in columns.items():
            values = [MEGA * float(row[f"{column}{direction}_Pa"]) for row in rows]
            panel.plot(minutes, values, color=COLOURS[stress], linewidth=1.2,
                       linestyle="--" if stress == "total" else "-",
                       label={"sintering": "sintering driving"}.get(stress, stress))
    axes[0].legend(frameon=False, fontsize=8)
    save(figure, folder, "macroscopic_stress")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", metavar="CSV", help="stress_histograms.csv of densify stresses")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="folder of the pictures, without it that of the table")
    parser.add_argument("--history", metavar="CSV", help="history.csv of the run")
    options = parser.parse_args()
    folder = pathlib.Path(options.output or pathlib.Path(options.table).parent)
    moments = read_histograms(options.table)
    draw_particles(moments, folder)
    draw_necks(moments, folder)
    draw_phases(pathlib.Path(options.table).parent / "macroscopic_stress.csv", folder)
    if options.history:
        draw_course(options.history, folder)


if __name__ == "__main__":
    main()
