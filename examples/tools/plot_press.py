#!/usr/bin/env python3
"""Draw a pressing: density over the section of the body at three moments, and its history.

    plot_press.py RESULT [-o FOLDER] [--times T T T]     (times in s; without them the ends of hold, cooling and process)

Writes density.png and history.png.  Needs python3-matplotlib and python3-vtk9.
"""

import argparse
import csv
import pathlib
import xml.etree.ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import vtk
from matplotlib.collections import PolyCollection
from vtk.util.numpy_support import vtk_to_numpy

MILLI, MEGA = 1e3, 1e-6


def section(path):
    """Corners of the elements after the step [mm] and their relative densities."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    place = vtk_to_numpy(grid.GetPoints().GetData()) + vtk_to_numpy(data.GetArray("displacement"))
    density = vtk_to_numpy(data.GetArray("relative_density"))
    corners = []
    for c in range(grid.GetNumberOfCells()):  # GetCell() gives the same object again and again
        cell = grid.GetCell(c)
        corners.append([cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())])
    return [MILLI * place[c, :2] for c in corners], np.array([density[c].mean() for c in corners])


def draw_sections(folder, times, out):
    sets = [(float(d.get("timestep")), d.get("file"))
            for d in xml.etree.ElementTree.parse(folder / "fields.pvd").getroot().iter("DataSet")]
    figure, axes = plt.subplots(1, len(times), figsize=(4 * len(times), 4), constrained_layout=True)
    for axis, time in zip(np.atleast_1d(axes), times):
        at, file = min(sets, key=lambda s: abs(s[0] - time))
        corners, density = section(folder / file)
        body = PolyCollection(corners, array=density, cmap="viridis", edgecolor="white", linewidth=0.3)
        axis.add_collection(body)
        axis.set(aspect="equal", xlabel="r [mm]", ylabel="z [mm]", title=f"t = {at:.0f} s")
        axis.autoscale_view()
        figure.colorbar(body, ax=axis, label="relative density")
    figure.savefig(out / "density.png", dpi=110)


def draw_history(rows, out):
    minutes = [float(r["time_s"]) / 60 for r in rows]
    column = lambda name, scale=1.0: [scale * float(r[name]) for r in rows]
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 6), constrained_layout=True)
    above.fill_between(minutes, column("relative_density_least"), column("relative_density_most"), alpha=0.3, lw=0)
    above.plot(minutes, column("relative_density"))
    above.set_ylabel("relative density: mean, least to most")
    heat = above.twinx()
    heat.plot(minutes, column("temperature_K"), color="tab:red", lw=0.8)
    heat.set_ylabel("temperature [K]", color="tab:red")
    for name, label in (("punch_force_N", "punch"), ("bottom_force_N", "lower punch"), ("wall_force_N", "wall, radial")):
        below.plot(minutes, column(name, 1e-3), label=label)
    below.plot(minutes, column("wall_friction_N", 1e-3), label="wall, friction")
    below.set(xlabel="time [min]", ylabel="force [kN]")
    below.legend()
    figure.savefig(out / "history.png", dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("result", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path)
    parser.add_argument("--times", type=float, nargs="+")
    options = parser.parse_args()
    out = options.out or options.result
    out.mkdir(parents=True, exist_ok=True)
    with open(options.result / "history.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    hottest = max(float(r["temperature_K"]) for r in rows)
    held = max(float(r["time_s"]) for r in rows if float(r["temperature_K"]) == hottest)
    pressed = max(float(r["time_s"]) for r in rows if float(r["pressure_Pa"]) > 0)
    draw_sections(options.result, options.times or [held, pressed, float(rows[-1]["time_s"])], out)
    draw_history(rows, out)


if __name__ == "__main__":
    main()
