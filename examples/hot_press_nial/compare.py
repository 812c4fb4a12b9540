#!/usr/bin/env python3
"""Hot press NiAl powder by processes I and II with both readings of the sintering contact, beside measured densities.

    compare.py [--again] [--arrangements N]

Runs the four cases with ./densify into results/hot_press_nial/CASE, unless their results are there from an earlier
call, prints the tables of README.md and draws shrinkage.png and rate.png (thesis Figs 5.25, 5.30).  With --arrangements
also process I to the end of the hold for N arrangements of the particles at mass factor 1e18, for mean and scatter.
Needs numpy, h5py and matplotlib.
"""

import argparse
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE.parents[1] / "results" / "hot_press_nial"
sys.path.insert(0, str(HERE.parent / "tools"))
from cases import build, run_case  # noqa: E402
from densify_results import Results  # noqa: E402

CASES = {
    "process_1": ("scene.toml", []),
    "process_1_second_reading": ("scene_second_reading.toml", []),
    "process_2": ("scene_process_2.toml", []),
    "process_2_second_reading": ("scene_second_reading.toml", ["process.stage.1.pressure=5 MPa"]),
}
# Process I without cooling: ten times fewer steps to the end of the hold, the last two stages cut to a second each.
ARRANGEMENT = ["integration.mass_scaling=1e18", "process.stage.7.temperature=1400 degC", "process.stage.7.duration=1 s",
               "process.stage.8.end=9302 s", "output.visualisation=false"]
MEASURED = {"I": "measured.csv", "II": "measured_process_2.csv"}


class Case:
    """A finished run and the rows of its history that end a stage."""

    def __init__(self, name, scene, settings, again):
        self.cost = run_case(HERE / scene, RESULTS / name, settings, again)
        results = Results(RESULTS / name)
        self.history = results.history
        self.stages = [results.snapshot(k).stage for k in range(1, len(results))]
        self.ends = [int(np.argmin(np.abs(self.history["time_s"] - t))) for t in results.times[1:]]

    def at_ends(self, column):
        return [float(self.history[column][row]) for row in self.ends]

    def punch_mean(self, first, last):
        """Mean of the pressure on the punch over the stages first to last, over the applied one."""
        rows = slice(self.ends[first - 1] + 1, self.ends[last] + 1)
        span = np.diff(self.history["time_s"])[self.ends[first - 1]:self.ends[last]]
        mean = np.average(self.history["punch_pressure_mean_Pa"][rows], weights=span)
        return float(mean / self.history["pressure_Pa"][self.ends[first]])

    def punch_rows(self):
        """From two minutes after loading to the end of cooling: number of rows, of those more than 1 % off, worst share."""
        time = np.asarray(self.history["time_s"])
        rows = (time > time[self.ends[0]] + 120) & (time <= time[self.ends[6]])
        off = np.abs(self.history["punch_pressure_mean_Pa"][rows] / self.history["pressure_Pa"][rows] - 1)
        return len(off), int(np.sum(off > 0.01)), float(np.max(off))


def measured(process):
    with open(HERE / MEASURED[process], encoding="utf-8") as file:
        return [float(row["relative_density"]) for row in csv.DictReader(line for line in file if line[0] != "#")]


def print_densities(cases):
    head = ("start", "loaded", "1", "2", "3", "4", "5", "cooled", "unloaded")
    for process, names in (("I", ("process_1", "process_1_second_reading")),
                           ("II", ("process_2", "process_2_second_reading"))):
        print(f"\n| process {process} | " + " | ".join(head) + " |")
        print("|---" * (len(head) + 1) + "|")
        print("| measured | | | " + " | ".join(f"{v:.2f}" for v in measured(process)) + " | | |")
        for name, label in zip(names, ("reading of the text", "second reading")):
            for column, of in (("relative_density", ""), ("relative_density_inner", ", inner")):
                values = [float(cases[name].history[column][0]), *cases[name].at_ends(column)]
                print(f"| {label}{of} | " + " | ".join(f"{v:.3f}" for v in values) + " |")
            off = np.array(cases[name].at_ends("relative_density")[1:6]) - np.array(measured(process))
            print(f"| {label} - measured | | | " + " | ".join(f"{v:+.3f}" for v in off) + " | | |")


def print_state(cases):
    print("\n| case | coordination at 1 / 5 | necks at equilibrium at 5 / end | largest overlap at 5 [r] "
          "| punch pressure / applied, heating and hold | cooling | rows off by 1 %, worst |")
    print("|---" * 7 + "|")
    for name, case in cases.items():
        rows, off, worst = case.punch_rows()
        z, eq = case.at_ends("coordination_number"), case.at_ends("neck_equilibrium_fraction")
        print(f"| {name} | {z[1]:.2f} / {z[5]:.2f} | {100 * eq[5]:.0f} % / {100 * eq[-1]:.0f} % "
              f"| {case.at_ends('largest_overlap')[5]:.2f} | {case.punch_mean(1, 5):.4f} "
              f"| {case.punch_mean(6, 6):.4f} | {off} of {rows}, {100 * worst:.1f} % |")


def print_cost(cases):
    print("\n| case | steps | loading | heating | hold | cooling | unloading | user time [s] | us per step |")
    print("|---" * 9 + "|")
    for name, case in cases.items():
        s = case.at_ends("steps")
        split = (s[0], s[3] - s[0], s[5] - s[3], s[6] - s[5], s[7] - s[6])
        print(f"| {name} | {s[-1]:.0f} | " + " | ".join(f"{v:.0f}" for v in split)
              + f" | {case.cost['seconds']:.0f} | {1e6 * case.cost['seconds'] / s[-1]:.0f} |")


def print_arrangements(count, again):
    print(f"\n| process I, {count} arrangements, mass factor 1e18 | loaded | 1 | 2 | 3 | 4 | 5 |")
    print("|---" * 7 + "|")
    for scene, label in (("scene.toml", "reading of the text"), ("scene_second_reading.toml", "second reading")):
        runs = []
        for seed in range(1, count + 1):
            name = f"arrangement_{seed}" + ("_second_reading" if label.startswith("second") else "")
            print(f"{name} ...", file=sys.stderr)
            settings = ARRANGEMENT + [f"specimen.seed={seed}", f"specimen.packing.seed={seed}"]
            runs.append(Case(name, scene, settings, again).at_ends("relative_density")[:6])
        mean, scatter = np.mean(runs, axis=0), np.std(runs, axis=0, ddof=1)
        print(f"| {label} | " + " | ".join(f"{m:.3f} ± {s:.3f}" for m, s in zip(mean, scatter)) + " |")


def save(figure, name):
    (HERE / "pictures").mkdir(exist_ok=True)
    figure.savefig(HERE / "pictures" / name, dpi=110)
    plt.close(figure)


def draw_shrinkage(case):
    """Thesis Fig. 5.25."""
    figure, axis = plt.subplots(figsize=(7, 4.2), constrained_layout=True)
    minutes = case.history["time_s"] / 60
    for column, label, style in (("shrinkage_x", "$\\phi_x$", "C0-"), ("shrinkage_y", "$\\phi_y$", "C1--"),
                                 ("shrinkage_z", "$\\phi_z$", "C2-"), ("shrinkage_volume", "$\\phi_V$", "k-")):
        axis.plot(minutes, case.history[column], style, label=label)
    axis.set_xlabel("time [min]")
    axis.set_ylabel("present over initial size")
    axis.grid(alpha=0.3)
    axis.legend()
    save(figure, "shrinkage.png")


def draw_rate(cases):
    """Thesis Fig. 5.30, from the start of sintering to the end of the hold."""
    figure, axis = plt.subplots(figsize=(7, 4.2), constrained_layout=True)
    for (name, case), style in zip(cases.items(), ("C0-", "C0--", "C3-", "C3--")):
        h = case.history
        chosen = np.zeros(len(h["time_s"]), dtype=bool)
        chosen[case.ends[0] + 1:case.ends[5] + 1] = True
        chosen &= np.diff(h["time_s"], prepend=0) > 40  # the row at the end of a stage may follow another closely
        density, rate = h["relative_density"][chosen], h["densification_rate_per_s"][chosen]
        smooth = np.convolve(rate, np.ones(3) / 3, mode="valid")
        process = "process II" if name.startswith("process_2") else "process I"
        reading = "second reading" if name.endswith("reading") else "reading of the text"
        axis.plot(density[1:-1], 60 * smooth, style, label=f"{process}, {reading}")
    axis.set_xlabel("relative density")
    axis.set_ylabel("densification rate [1/min]")
    axis.grid(alpha=0.3)
    axis.legend()
    save(figure, "rate.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--again", action="store_true", help="run all cases again")
    parser.add_argument("--arrangements", type=int, default=0, metavar="N", help="arrangements for mean and scatter")
    options = parser.parse_args()
    build()
    cases = {}
    for name in CASES:
        print(f"{name} ...", file=sys.stderr)
        cases[name] = Case(name, *CASES[name], options.again)
    print_densities(cases)
    print_state(cases)
    print_cost(cases)
    draw_shrinkage(cases["process_1"])
    draw_rate(cases)
    if options.arrangements:
        print_arrangements(options.arrangements, options.again)


if __name__ == "__main__":
    main()
