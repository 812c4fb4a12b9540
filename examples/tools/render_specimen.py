#!/usr/bin/env python3
"""Draw a specimen before and after, side by side at one scale: spheres, die and punch.

    xvfb-run -a render_specimen.py results/hot_press_nial -o specimen.png [--snapshots 0 -1] [--colour size|stress]

Colours are diameters, or mean stresses (tension positive).  Needs numpy, h5py, Pillow and VTK (Debian:
python3-pil python3-vtk9 xvfb xauth).
"""

import argparse

import numpy as np
import vtk
from PIL import Image
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from densify_results import Results

INK = (0.15, 0.15, 0.15)


def colour_table(name, low, high):
    """Colours from blue over white to red for stresses, from dark to light orange for sizes."""
    function = vtk.vtkColorTransferFunction()
    stops = ([(0, 0.13, 0.30, 0.62), (0.5, 0.93, 0.93, 0.93), (1, 0.70, 0.10, 0.13)] if name == "stress" else
             [(0, 0.98, 0.86, 0.60), (0.35, 0.93, 0.62, 0.25), (0.7, 0.73, 0.36, 0.12), (1, 0.38, 0.16, 0.08)])
    for share, *rgb in stops:
        function.AddRGBPoint(low + share * (high - low), *rgb)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    table.SetRange(low, high)
    for k in range(256):
        table.SetTableValue(k, *function.GetColor(low + k / 255 * (high - low)), 1.0)
    return table


def spheres(snapshot, values, table):
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(snapshot.particles["position"] * 1e6, deep=True))
    data.SetPoints(points)
    for name, array in (("diameter", 2e6 * snapshot.particles["radius"]), ("colour", values)):
        column = numpy_to_vtk(np.ascontiguousarray(array), deep=True)
        column.SetName(name)
        data.GetPointData().AddArray(column)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(0.5)
    ball.SetThetaResolution(40)
    ball.SetPhiResolution(24)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScaleArray("diameter")
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colour")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetSpecular(0.25)
    actor.GetProperty().SetSpecularPower(25)
    actor.GetProperty().SetAmbient(0.25)
    actor.GetProperty().SetDiffuse(0.8)
    return actor


def ring(radius, height, width=2.0):
    source = vtk.vtkRegularPolygonSource()
    source.SetNumberOfSides(120)
    source.SetRadius(radius)
    source.SetCenter(0, 0, height)
    source.SetNormal(0, 0, 1)
    source.GeneratePolygonOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(INK)
    actor.GetProperty().SetLineWidth(width)
    actor.GetProperty().LightingOff()
    return actor


def shell(radius, low, high):
    """The lateral wall as a faint shell, seen from inside only, so that it never hides a particle."""
    source = vtk.vtkCylinderSource()
    source.SetRadius(radius)
    source.SetHeight(high - low)
    source.SetResolution(120)
    source.CappingOff()
    turn = vtk.vtkTransform()
    turn.Translate(0, 0, 0.5 * (low + high))
    turn.RotateX(90)
    moved = vtk.vtkTransformPolyDataFilter()
    moved.SetInputConnection(source.GetOutputPort())
    moved.SetTransform(turn)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(moved.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.80, 0.84, 0.88)
    actor.GetProperty().SetAmbient(0.7)
    actor.GetProperty().FrontfaceCullingOn()
    return actor


def caption(text, size, x, y, centred):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    style = actor.GetTextProperty()
    style.SetFontSize(size)
    style.SetColor(INK)
    style.SetFontFamilyToArial()
    if centred:
        style.SetJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    return actor


def wall(snapshot, name):
    return list(snapshot.walls["name"]).index(name)


def scene_of(snapshot, values, table, top, panel):
    """One panel: the specimen in its die, which reaches from the bottom to `top` [um]."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*panel)
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(spheres(snapshot, values, table))
    radius = 1e6 * snapshot.walls["radius"][wall(snapshot, "die")]
    punch = 1e6 * snapshot.walls["point"][wall(snapshot, "punch"), 2]
    renderer.AddActor(shell(radius, 0, top))
    for height, width in ((0, 2.0), (punch, 3.0), (top, 2.0)):
        renderer.AddActor(ring(radius, height, width))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    middle = 0.42 * top  # leaves room for the caption below
    tilt = np.radians(14)
    camera.SetFocalPoint(0, 0, middle)
    camera.SetPosition(0, -400 * np.cos(tilt), middle + 400 * np.sin(tilt))
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(0.68 * top)
    renderer.ResetCameraClippingRange()
    celsius = snapshot.temperature - 273.15
    renderer.AddActor2D(caption(f"{snapshot.time / 60:.0f} min, {celsius:.0f} °C, {snapshot.pressure * 1e-6:g} MPa\n"
                                f"relative density {snapshot.relative_density:.3f}, height {punch:.1f} µm",
                                20, 0.5, 0.03, True))
    return renderer


def bar(table, title, panel, stress):
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*panel)
    renderer.SetBackground(1, 1, 1)
    actor = vtk.vtkScalarBarActor()
    actor.SetLookupTable(table)
    actor.SetNumberOfLabels(5)
    actor.SetLabelFormat("%.0f" if stress else "%.1f")
    actor.SetWidth(0.35)
    actor.SetHeight(0.6)
    actor.SetPosition(0.15, 0.2)
    actor.UnconstrainedFontSizeOn()
    actor.GetLabelTextProperty().SetFontSize(18)
    labels = actor.GetLabelTextProperty()
    labels.SetColor(INK)
    labels.ItalicOff()
    labels.BoldOff()
    labels.ShadowOff()
    renderer.AddActor2D(actor)
    renderer.AddActor2D(caption(title, 18, 0.05, 0.83, False))
    return renderer


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="DIR", help="results folder of a run in a cylinder")
    parser.add_argument("-o", "--output", required=True, metavar="PNG", help="picture to write")
    parser.add_argument("--snapshots", nargs=2, type=int, default=[0, -1], metavar="N", help="default: first and last")
    parser.add_argument("--colour", choices=["size", "stress"], default="size")
    options = parser.parse_args()

    results = Results(options.folder)
    pair = [results.snapshot(n) for n in options.snapshots]
    top = max(1e6 * s.walls["point"][wall(s, "punch"), 2] for s in pair)
    if options.colour == "stress":
        values = [s.particles["stress"][:, :3].mean(axis=1) * 1e-6 for s in pair]
        largest = float(np.percentile(np.abs(np.concatenate(values)), 95))
        table, title = colour_table("stress", -largest, largest), "mean stress\n[MPa]"
    else:
        values = [2e6 * s.particles["radius"] for s in pair]
        table = colour_table("size", min(v.min() for v in values), max(v.max() for v in values))
        title = "diameter\n[µm]"

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1160, 720)
    for k, snapshot in enumerate(pair):
        window.AddRenderer(scene_of(snapshot, values[k], table, top, (0.43 * k, 0, 0.43 * (k + 1), 1)))
    window.AddRenderer(bar(table, title, (0.86, 0, 1, 1), options.colour == "stress"))
    window.Render()
    picture = vtk.vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    picture.Update()
    image = picture.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3]
    # A palette makes the file a third as large.
    few = Image.fromarray(np.ascontiguousarray(pixels)).quantize(256, method=Image.Quantize.MAXCOVERAGE)
    few.save(options.output, optimize=True)


if __name__ == "__main__":
    main()
