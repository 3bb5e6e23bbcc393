"""What the same picture costs in other programs: a table of docs/speed.md.

    python docs/speed_peers.py boxes.json 1000   with vectorplot: its own cost, and the scene as a file
    python docs/speed_peers.py boxes.json        with vtk or matplotlib, in an environment of their own: theirs

The peers are not needed by the package, and are installed by hand. What each of them makes is no more than the nearest
to a drawing with exact hidden lines that it offers.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
EYE = (2.2, -2.6, 1.9)


def seconds(action: Callable[[], object]) -> float:
    """Of the processor, for the second time it is done."""
    action()
    start = time.process_time()
    action()
    return time.process_time() - start


def vectorplot_seconds(path: Path) -> dict[str, float]:
    """Exact hidden lines as SVG; the scene goes to the file."""
    import vectorplot as vp
    from vectorplot.testing.shapes import rotated_boxes

    scene = rotated_boxes(COUNT)
    meshes = [item.mesh for item in scene.items]
    path.write_text(json.dumps([[m.vertices.tolist(), m.corners.reshape(-1, 4).tolist()] for m in meshes]))
    with tempfile.TemporaryDirectory() as folder:
        return {"vectorplot, exact lines": seconds(lambda: vp.save(vp.draw(scene, jobs=1), f"{folder}/a.svg"))}


def matplotlib_seconds(path: Path) -> dict[str, float]:
    """Faces painted in the order of their middles, as SVG."""
    import matplotlib
    import numpy as np

    matplotlib.use("svg")
    from matplotlib import pyplot
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    boxes = json.loads(path.read_text())
    faces = np.concatenate([np.array(points)[np.array(corners)] for points, corners in boxes])

    def picture() -> None:
        figure = pyplot.figure()
        axes = figure.add_subplot(projection="3d")
        axes.add_collection3d(Poly3DCollection(faces, facecolor="white", edgecolor="black"))
        axes.auto_scale_xyz(*faces.reshape(-1, 3).T)
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(f"{folder}/a.svg")
        pyplot.close(figure)

    return {"matplotlib, faces by their middles": seconds(picture)}


def vtk_seconds(path: Path) -> dict[str, float]:
    """Pixels; and vectors by GL2PS, sorted by their middles or cut by a tree of planes."""
    import vtk

    boxes = json.loads(path.read_text())
    joined = vtk.vtkAppendPolyData()
    for points, corners in boxes:
        data, spots, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        for point in points:
            spots.InsertNextPoint(point)
        for face in corners:
            cells.InsertNextCell(len(face), face)
        data.SetPoints(spots)
        data.SetPolys(cells)
        joined.AddInputData(data)
    mapper, actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
    mapper.SetInputConnection(joined.GetOutputPort())
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(1, 1, 1)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().LightingOff()
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1200, 900)
    window.AddRenderer(renderer)
    renderer.AddActor(actor)
    renderer.GetActiveCamera().SetPosition(*EYE)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    found = {"vtk, pixels": seconds(window.Render)}
    for name in ("Simple", "BSP"):

        def export(name: str = name) -> None:
            with tempfile.TemporaryDirectory() as folder:
                exporter = vtk.vtkGL2PSExporter()
                exporter.SetRenderWindow(window)
                exporter.SetFileFormatToSVG()
                exporter.CompressOff()
                getattr(exporter, f"SetSortTo{name}")()
                exporter.SetFilePrefix(f"{folder}/a")
                exporter.Write()

        found[f"vtk, GL2PS {name}"] = seconds(export)
    return found


if __name__ == "__main__":
    scene = Path(sys.argv[1])
    here = {"vectorplot": vectorplot_seconds, "matplotlib": matplotlib_seconds, "vtk": vtk_seconds}
    for name, measure in here.items():
        if find_spec(name):
            for what, took in measure(scene).items():
                print(f"{what:<36} {took:8.3f} s", flush=True)
