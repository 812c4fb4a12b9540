"""Draws the figures of doc/stability.md from the tables that the tests of the extremes write.

    mkdir tables; DENSIFY_STABILITY_TABLES=$PWD/tables build/release/bin/test_extremes
    /usr/bin/python3 examples/tools/plot_stability.py tables doc/pictures
"""

import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def table(folder, name):
    """Columns of a table by name: numbers where they are numbers."""
    with open(folder / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = {key: [row[key] for row in rows] for key in rows[0]}
    for key, values in columns.items():
        try:
            columns[key] = np.array([float(v) for v in values])
        except ValueError:
            pass
    return columns


def mass_factor(folder, out):
    t = table(folder, "mass_factor")
    fig, left = plt.subplots(figsize=(7, 4))
    left.loglog(t["factor"], np.maximum(abs(t["error"]), 1e-7), "o-", color="C0")
    left.axhline(0.02, color="C0", lw=0.8, ls=":")
    left.set_xlabel("mass factor")
    left.set_ylabel("relative error of the strain after 1000 s", color="C0")
    right = left.twinx()
    right.semilogx(t["factor"], 100 * t["share_not_quasi_static"], "s--", color="C3")
    right.set_ylabel("process time not quasi-static [%]", color="C3")
    right.set_ylim(-3, 103)
    fig.tight_layout()
    fig.savefig(out / "stability_mass_factor.png", dpi=110)


def step_limit(folder, out):
    t = table(folder, "step_limit")
    models = list(dict.fromkeys(t["model"]))
    bodies = list(dict.fromkeys(t["body"]))
    fig, ax = plt.subplots(figsize=(7, 4))
    for b, body in enumerate(bodies):
        ratio = [r for r, m, o in zip(t["own_over_true"], t["model"], t["body"]) if o == body]
        ax.bar(np.arange(len(models)) + 0.2 * (b - 1.5), ratio, 0.18, label=body)
    ax.axhline(1, color="k", lw=0.8)
    ax.set_xticks(range(len(models)), models)
    ax.set_ylabel("limit in use / limit of the whole system")
    ax.set_ylim(0, 1.25)
    ax.legend(ncol=4, loc="upper center", frameon=False)
    fig.tight_layout()
    fig.savefig(out / "stability_step_limit.png", dpi=110)


def ranges(folder, out):
    fig, axes = plt.subplots(2, 3, figsize=(10, 5.5))
    cases = [
        ("radius", "radius", "radius [m]"),
        ("size_ratio", "ratio", "ratio of radii"),
        ("stiffness_ratio", "ratio", "ratio of moduli"),
        ("pressure", "pressure", "sudden pressure [Pa]"),
        ("heating_rate", "rate", "heating rate [K/s]"),
    ]
    for ax, (name, key, label) in zip(axes.flat, cases):
        t = table(folder, name)
        ax.loglog(t[key], np.maximum(abs(t["error"]), 1e-12), "o-")
        ax.set_xlabel(label)
    t = table(folder, "relaxation")
    ax = axes.flat[5]
    for key, style in (("backward_euler", "o-"), ("trapezoidal", "s--")):
        ax.loglog(t["relaxation_over_step"], np.maximum(t[key], 1e-12), style, ms=3, label=key.replace("_", " "))
    ax.legend(frameon=False, fontsize=8)
    ax.set_xlabel("relaxation time / step")
    for ax in axes[:, 0]:
        ax.set_ylabel("relative error")
    fig.tight_layout()
    fig.savefig(out / "stability_ranges.png", dpi=110)


if __name__ == "__main__":
    tables, figures = map(pathlib.Path, sys.argv[1:3])
    for draw in (mass_factor, step_limit, ranges):
        draw(tables, figures)
