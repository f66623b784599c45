"""Draws a run with ParaView: stones, sleeper and rail, deformed and coloured by displacement, at the instant at which the
rail (without one: the stones) has moved farthest. Stones that have moved farther still, loose ones, are shown at the end
of the colour scale.

usage: pvbatch cases/view_run.py DIR [PICTURE [EXAGGERATION]]      (Debian: paraview, python3-paraview)

Without a screen: xvfb-run -a pvbatch ... (Debian: xvfb, xauth). The same steps by hand: open qdem.xdmf and fem.xdmf with the reader "Xdmf3 Reader S", filter Warp By Vector.
"""
import os
import sys

from paraview.simple import (ColorBy, GetActiveViewOrCreate, GetColorTransferFunction, GetScalarBar, Render,
                             SaveScreenshot, Show, WarpByVector, Xdmf3ReaderS)


def largest_displacement(source):
    """Of the points at the source's present time [m]."""
    low, high = source.PointData["displacement"].GetRange(-1)
    return high


def time_of_largest(source):
    """Time [s] and size [m] of the largest displacement."""
    source.UpdatePipelineInformation()
    times = list(source.TimestepValues)
    sizes = []
    for time in times:
        source.UpdatePipeline(time)
        sizes.append(largest_displacement(source))
    return times[sizes.index(max(sizes))], max(sizes)


def draw(folder, picture, exaggeration):
    view = GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1400, 800]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    names = [name for name in ("fem.xdmf", "qdem.xdmf") if os.path.exists(os.path.join(folder, name))]
    sources = [Xdmf3ReaderS(FileName=[os.path.join(folder, name)]) for name in names]
    time, size = time_of_largest(sources[0])
    view.ViewTime = time
    for source in sources:
        warped = WarpByVector(Input=source)
        warped.Vectors = ["POINTS", "displacement"]
        warped.ScaleFactor = exaggeration
        warped.UpdatePipeline(time)
        shown = Show(warped, view)
        ColorBy(shown, ("POINTS", "displacement", "Magnitude"))
    colours = GetColorTransferFunction("displacement")
    colours.RescaleTransferFunction(0.0, size)
    shown.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "displacement [m]", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    Render(view)  # the first one moves the camera
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0.0, 0.7, -0.2], [1.9, 3.4, 1.0], [0.0, 0.0, 1.0]
    Render(view)
    SaveScreenshot(picture, view)
    print(f"{picture}: t = {time:.4g} s, largest displacement {1e3 * size:.3g} mm, drawn {exaggeration:g} times")


if len(sys.argv) < 2:
    sys.exit(__doc__)
run = sys.argv[1]
draw(run, sys.argv[2] if len(sys.argv) > 2 else os.path.join(run, "view.png"),
     float(sys.argv[3]) if len(sys.argv) > 3 else 50.0)
