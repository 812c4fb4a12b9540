#!/usr/bin/env python3
"""Draw a response table: loose compaction, viscosities and sintering stress beside Skorohod and Olevsky's functions, and
the path that is not in it.

    plot_table.py TABLE [-o PICTURE]

Bands are the scatter of one volume element.  Writes table.png.  Needs python3-matplotlib and python3-h5py.
"""

import argparse
import pathlib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

MEGA = 1e-6


def moduli(tensor):
    """Bulk and shear part of tensors given as 11, 33, 12, 13, 44."""
    c11, c33, c12, c13, c44 = tensor.T
    bulk = (2 * c11 + c33 + 2 * c12 + 4 * c13) / 9
    shear = (2 * c11 + c33 - c12 - 2 * c13 + 6 * c44 + 3 * (c11 - c12)) / 15
    return bulk, shear


def column(group, name):
    return np.array(group[name]).reshape(len(group["relative_density"]), -1).squeeze()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path, default=pathlib.Path("table.png"))
    options = parser.parse_args()
    file = h5py.File(options.table)
    figure, ((loose, viscous), (stress, check)) = plt.subplots(2, 2, figsize=(11, 8), constrained_layout=True)

    cold = file["cold"]
    density, scatter = column(cold, "relative_density"), column(cold, "relative_density_scatter")
    axial = MEGA * column(cold, "axial_pressure")
    loose.fill_betweenx(axial, density - scatter, density + scatter, alpha=0.3, lw=0)
    loose.plot(density, axial, label="axial")
    loose.plot(density, MEGA * column(cold, "lateral_pressure"), label="lateral")
    loose.set(xlabel="relative density", ylabel="pressure in a die [MPa]", yscale="log", title="loose powder")
    loose.legend()

    scale = None
    for key in file["sintering"]:
        branch = file["sintering"][key]
        name = f"{branch.attrs['path'].decode() if isinstance(branch.attrs['path'], bytes) else branch.attrs['path']}" \
               f", pressure x {branch.attrs['pressure_factor']:g}"
        density = column(branch, "relative_density")
        bulk, shear = moduli(column(branch, "viscosity"))
        line, = viscous.plot(density, bulk, label=name)
        viscous.plot(density, shear, color=line.get_color(), ls="--")
        spread = np.exp(column(branch, "viscosity_scatter"))
        viscous.fill_between(density, bulk / spread, bulk * spread, color=line.get_color(), alpha=0.2, lw=0)
        mean = MEGA * column(branch, "sintering_stress") @ np.array([2 / 3, 1 / 3])
        stress.plot(density, mean, label=name)
        part = column(branch, "sintering_stress_scatter")
        stress.fill_between(density, mean * (1 - part), mean * (1 + part), color=line.get_color(), alpha=0.2, lw=0)
        if scale is None:  # Skorohod and Olevsky through the middle of the first branch
            middle = len(density) // 2
            eta = shear[middle] / density[middle]**2
            gamma = mean[middle] / density[middle]**2
            rho = np.linspace(density[0], density[-1], 200)
            scale = rho, eta, gamma
    rho, eta, gamma = scale
    viscous.plot(rho, 4 / 3 * eta * rho**3 / (1 - rho), "k", lw=0.8, label="Skorohod-Olevsky, bulk")
    viscous.plot(rho, eta * rho**2, "k--", lw=0.8, label="the same, shear")
    stress.plot(rho, gamma * rho**2, "k", lw=0.8, label="Skorohod-Olevsky")
    viscous.set(xlabel="relative density", ylabel="viscosity [Pa s], bulk (line) and shear (dashed)", yscale="log",
                title=f"with necks, at {file.attrs['reference_temperature_K'] - 273.15:.0f} °C")
    stress.set(xlabel="relative density", ylabel="sintering stress [MPa]")
    viscous.legend(fontsize="x-small")
    stress.legend(fontsize="x-small")

    minutes = np.array(file["check/time"]).ravel() / 60
    check.plot(minutes, np.array(file["check/relative_density_of_element"]).ravel(), "o", ms=3, label="volume elements")
    check.plot(minutes, np.array(file["check/relative_density_by_table"]).ravel(), label="the table")
    check.set(xlabel="time [min]", ylabel="relative density",
              title=f"a path that is not in it: pressure x {file['check'].attrs['pressure_factor']:.2g}, "
                    f"heating x {file['check'].attrs['heating_factor']:g}")
    check.legend()
    figure.savefig(options.out, dpi=110)


if __name__ == "__main__":
    main()
