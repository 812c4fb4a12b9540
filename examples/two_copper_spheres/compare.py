#!/usr/bin/env python3
"""Measure what two copper spheres cost with the viscous and the viscoelastic model (thesis Table 5.2), and draw.

    compare.py [--again]

Runs every case with ./densify into results/two_copper_spheres/CASE, unless its results are there from an earlier call,
prints the tables of README.md and draws its pictures.  The viscous run at mass factor 1e14 (2.6e10 steps) is measured
over 1e8 steps and extrapolated.  Needs numpy, h5py and matplotlib.
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
ROOT = HERE.parents[1]
RESULTS = ROOT / "results" / "two_copper_spheres"
sys.path.insert(0, str(HERE.parent / "tools"))
from cases import build, run_case  # noqa: E402
from densify_results import Results  # noqa: E402

# Thesis Table 5.1 and what follows from it.
RADIUS = 22.5e-6  # [m]
MASS = 8920 * 4 / 3 * math.pi * RADIUS**3  # [kg]
STIFFNESS = 7e5  # [N/m]
GAMMA, PSI = 1.72, math.radians(146)  # [J/m^2], dihedral angle
DIFFUSION = 3.832e-19 * 1.18e-29 / (1.380649e-23 * 1300)  # D_eff (4.81) [m^5/(N s)]
LARGEST_NECK = RADIUS * math.sin(PSI / 2)  # a_max (4.32) [m]
FREE_END, PRESSED_END = 2.610161505e6, 1.097594634e5  # of the closed form [s]

DENSE = ["output.history_interval=500 s"]
THESIS = ["integration.rule=thesis", "contact.sintering.update=trapezoidal", "contact.sintering.starting_neck=0.01"]
EARLY = ["process.stage.1.duration=2e4 s"]


def fixed(step, duration):
    return [f"integration.fixed_step={step} s", f"process.stage.1.duration={duration} s"]


# case: scene, mass factor, settings
CASES = {
    "viscoelastic_1e14": ("scene.toml", 1e14, DENSE),
    "viscoelastic_1e14_thesis_rule": ("scene.toml", 1e14, DENSE + THESIS + ["integration.step_safety=0.8"]),
    "viscoelastic_1e16": ("scene.toml", 1e16, DENSE),
    "viscoelastic_1e16_thesis_rule": ("scene.toml", 1e16, DENSE + THESIS + ["integration.step_safety=0.8"]),
    "viscous_1e14": ("scene_viscous.toml", 1e14, fixed("1e-4", "1e4")),
    "viscous_1e16": ("scene_viscous.toml", 1e16, fixed("1e-2", "2.7e6") + DENSE),
    "pressed_1e14": ("scene_under_force.toml", 1e14, ["output.history_interval=50 s"]),
    "pressed_1e16": ("scene_under_force.toml", 1e16, ["output.history_interval=50 s"]),
}

# Short runs with rows close together, for the picture of the critical steps.
START = ["contact.sintering.starting_neck=0.01"]
for factor in ("1e14", "1e16"):
    for name, scene, settings in (
        ("viscous", "scene_viscous.toml", ["integration.step_safety=0.9"]),
        ("viscoelastic", "scene.toml", ["integration.step_safety=0.9"]),
        ("viscoelastic_thesis_rule", "scene.toml", THESIS + ["integration.step_safety=0.9"]),
    ):
        for span, duration, interval in (("first", 20, 0.01), ("early", 2e4, 10)):
            CASES[f"step_{name}_{factor}_{span}"] = (
                scene,
                float(factor),
                settings + START + ["integration.limit_interval=1", f"process.stage.1.duration={duration} s",
                                    f"output.history_interval={interval} s"],
            )


def time_to_neck(neck, force=0.0):
    """Time from a = 0 to the neck radius without inertia, da/dt = 8 D r (pi gamma (A + b a) + F) / (pi a^5) [s]."""
    big_a, b = 4 * RADIUS * (1 - math.cos(PSI / 2)), math.sin(PSI / 2)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    a = 0.5 * neck * (nodes + 1)
    slowness = math.pi * a**5 / (8 * DIFFUSION * RADIUS * (math.pi * GAMMA * (big_a + b * a) + force))
    return 0.5 * neck * float(np.dot(weights, slowness))


def strain_at(time, force=0.0):
    """Strain u / 2 r of the closed form, with a^2 = 2 r u; by bisection."""
    low, high = 0.0, LARGEST_NECK
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if time_to_neck(middle, force) < time else (low, middle)
    return low**2 / (4 * RADIUS**2)


def run(name, again=False):
    """Runs a case unless its results are there; returns what it cost."""
    scene, factor, settings = CASES[name]
    return run_case(HERE / scene, RESULTS / name,
                    [f"integration.mass_scaling={factor:g}", "output.visualisation=false", *settings], again)


def strain(history):
    """Strain u / 2 r since the start; the box of the pair is twice the distance of the centres."""
    return 2 * (1 - history["shrinkage_x"])


def strain_of_run(name, time):
    """Between two rows by a power law, which the strain very nearly is."""
    history = Results(RESULTS / name).history
    t, e = history["time_s"][1:], strain(history)[1:]
    return math.exp(np.interp(math.log(time), np.log(t), np.log(e)))


def print_cost():
    print("| mass factor | model | steps | mean step [s] | user time [s] | per step [ns] |")
    print("|---|---|---|---|---|---|")
    for name in ("viscous_1e14", "viscoelastic_1e14", "viscoelastic_1e14_thesis_rule", "viscous_1e16",
                 "viscoelastic_1e16", "viscoelastic_1e16_thesis_rule", "pressed_1e14", "pressed_1e16"):
        cost = run(name)
        model, factor = name.split("_", 2)[0], name.split("_", 2)[1]
        steps, seconds, time = cost["steps"], cost["seconds"], cost["time"]
        per_step, mark = seconds / steps, ""
        if model == "viscous" and time < 0.99 * FREE_END:
            mark = f" (from {steps:.3g} steps)"
            steps *= FREE_END / time
            seconds, time = per_step * steps, FREE_END
        rule = ", thesis rule" if name.endswith("rule") else ""
        print(f"| {factor} | {model}{rule}{mark} | {steps:.4g} | {time / steps:.3g} | {seconds:.3g} "
              f"| {per_step * 1e9:.0f} |")


def print_strains():
    for force, runs, times in ((0.0, ("viscoelastic_1e14", "viscoelastic_1e16", "viscous_1e16"), (1e3, 1e4, 1e5, 1e6)),
                               (0.01, ("pressed_1e14", "pressed_1e16"), (1e3, 1e4, 1e5))):
        title = "strain under 0.01 N at [s]" if force else "strain, free, at [s]"
        print(f"\n| {title} | closed form | " + " | ".join(name.replace("_", " ") for name in runs) + " |")
        print("|---" * (len(runs) + 2) + "|")
        for time in times:
            exact = strain_at(time, force)
            cells = [f"{exact:.8f}"]
            for name in runs:
                if run(name)["time"] < time:
                    cells.append("-")
                    continue
                measured = strain_of_run(name, time)
                cells.append(f"{measured:.8f} ({measured / exact - 1:+.1e})")
            print(f"| {time:.0e} | " + " | ".join(cells) + " |")
    print("\n| run | end time [s] | closed form [s] | deviation |")
    print("|---|---|---|---|")
    for name in ("viscoelastic_1e14", "viscoelastic_1e16", "viscoelastic_1e14_thesis_rule",
                 "viscoelastic_1e16_thesis_rule", "viscous_1e16", "pressed_1e14", "pressed_1e16"):
        end = PRESSED_END if name.startswith("pressed") else FREE_END
        time = run(name)["time"]
        if time > 0.99 * end:
            print(f"| {name.replace('_', ' ')} | {time:.9g} | {end:.9g} | {time / end - 1:+.1e} |")


def save(figure, name):
    (HERE / "pictures").mkdir(exist_ok=True)
    figure.savefig(HERE / "pictures" / name, dpi=110)
    plt.close(figure)


def draw_displacement():
    """Thesis Figs 5.2a and 5.16."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    curves = (("viscoelastic_1e14", "free, viscoelastic, 1e14", "C0", "-"),
              ("viscous_1e16", "free, viscous, 1e16", "C1", "--"),
              ("pressed_1e14", "under 0.01 N, viscoelastic, 1e14", "C3", "-"))
    for axis in axes:
        for name, label, colour, dash in curves:
            history = Results(RESULTS / name).history
            axis.plot(history["time_s"][1:], strain(history)[1:], dash, color=colour, label=label)
        for force, end in ((0.0, FREE_END), (0.01, PRESSED_END)):
            times = np.geomspace(1e3, 0.9999 * end, 14)
            axis.plot(times, [strain_at(t, force) for t in times], "ko", markersize=4, markerfacecolor="none",
                      label=None if force else "closed form without inertia")
        axis.set_xlabel("time [s]")
        axis.set_ylabel("relative displacement $u/2r$")
        axis.grid(alpha=0.3)
    axes[1].set_xscale("log")
    axes[1].set_yscale("log")
    axes[1].set_xlim(3e2, 4e6)
    axes[1].set_ylim(8e-3, 0.3)
    axes[0].legend()
    save(figure, "displacement.png")


def draw_steps():
    """Thesis Fig. 5.12."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), sharey=True, constrained_layout=True)
    for axis, factor in zip(axes, ("1e14", "1e16")):
        for name, label, colour, dash in (("viscous", "viscous: $m/\\eta$, at most $2/\\omega$", "C1", "-"),
                                          ("viscoelastic_thesis_rule", "viscoelastic, thesis rule: "
                                           "min($2/\\omega, \\eta/k$)", "C2", "-"),
                                          ("viscoelastic", "viscoelastic, backward Euler: $2/\\omega$", "C0", "--")):
            times, steps = [], []
            for span in ("first", "early"):
                history = Results(RESULTS / f"step_{name}_{factor}_{span}").history
                t = history["time_s"]
                chosen = (t > (12 if times else 0)) & (t < 0.6 * t[-1] if span == "first" else t < t[-1])
                times += list(t[chosen])  # without the steps that are cut to the end of a stage
                steps += list(history["time_step_s"][chosen] / 0.9)
            axis.loglog(times, steps, dash, color=colour, label=label)
        mass = MASS * float(factor)
        eta = math.pi * LARGEST_NECK**4 / (8 * DIFFUSION)
        axis.axhline(mass / eta, color="C1", linestyle=":", linewidth=1)
        axis.text(1.5e4, mass / eta / 1.7, f"viscous at the end: {mass / eta:.3g} s", color="C1", fontsize=8,
                  ha="right")
        limit = math.sqrt(2 * mass / STIFFNESS)
        axis.text(0.02, limit * 1.2, f"$2/\\omega$ = {limit:.4g} s", color="C0", fontsize=8)
        axis.set_title(f"mass factor {factor}")
        axis.set_xlabel("time [s]")
        axis.grid(alpha=0.3)
        axis.set_xlim(1e-2, 2e4)
    axes[0].set_ylabel("critical time step [s]")
    axes[1].legend(loc="lower right", fontsize=8)
    save(figure, "critical_step.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--again", action="store_true", help="measure all cases again")
    options = parser.parse_args()
    build()
    for name in CASES:
        print(f"{name} ...", file=sys.stderr)
        run(name, options.again)
    print_cost()
    print_strains()
    draw_displacement()
    draw_steps()


if __name__ == "__main__":
    main()
