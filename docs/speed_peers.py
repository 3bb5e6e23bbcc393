"""What the same picture costs in other programs: tables of docs/speed.md.

    python docs/speed_peers.py boxes.json 1000    with vectorplot: its own cost, and the scene as a file
    python docs/speed_peers.py boxes.json         with vtk or matplotlib, in an environment of their own: theirs
    python docs/speed_peers.py molecule.xyz 1000  a molecule of so many atoms, likewise; also with xyzrender

The peers are not needed by the package, and are installed by hand. What each of them makes is no more than the nearest
to a drawing with exact hidden lines that it offers.
"""

from __future__ import annotations

import itertools
import json
import math
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

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


def diamond(count: int) -> list[tuple[float, ...]]:
    """(x, y, z) of so many atoms of carbon in a cube, each a little off its place."""
    import numpy as np

    side = math.ceil((count / 8) ** (1 / 3))
    cells = np.stack(np.meshgrid(*3 * [np.arange(side)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    face = np.array([(0, 0, 0), (2, 2, 0), (2, 0, 2), (0, 2, 2)])
    places = (4 * cells + np.concatenate([face, face + 1])).reshape(-1, 3)[:count] * (3.567 / 4)
    return (places + np.random.default_rng(0).uniform(-0.05, 0.05, places.shape)).round(3).tolist()


def atoms_of(path: Path) -> tuple[list[tuple[float, ...]], list[tuple[int, int]]]:
    """The places of a file, and the pairs of neighbours among them."""
    atoms = [tuple(map(float, line.split()[1:])) for line in path.read_text().splitlines()[2:]]
    pairs = itertools.combinations(range(len(atoms)), 2)
    return atoms, [(a, b) for a, b in pairs if math.dist(atoms[a], atoms[b]) < 1.85]


def vectorplot_molecule(path: Path) -> dict[str, float]:
    """Painted as SVG, and pixels; the molecule goes to the file."""
    import vectorplot as vp

    rows = [f"C {x:.3f} {y:.3f} {z:.3f}" for x, y, z in diamond(COUNT)]
    path.write_text("\n".join([str(len(rows)), "a cube", *rows, ""]))
    scene = vp.read(path)
    with tempfile.TemporaryDirectory() as folder:
        return {
            "vectorplot, painted": seconds(lambda: vp.save(vp.paint(scene, jobs=1), f"{folder}/a.svg")),
            "vectorplot, pixels": seconds(
                lambda: vp.save(vp.render(scene, size=(1200, 900), jobs=1), f"{folder}/a.png")
            ),
        }


def xyzrender_molecule(path: Path) -> dict[str, float]:
    """A disc an atom with one gradient, as SVG."""
    import xyzrender

    return {"xyzrender, discs": seconds(lambda: xyzrender.render(xyzrender.load(path)))}


def matplotlib_molecule(path: Path) -> dict[str, float]:
    """Facets of balls and rods in the order of their middles, as SVG."""
    import matplotlib
    import numpy as np

    matplotlib.use("svg")
    from matplotlib import pyplot

    atoms, bonds = atoms_of(path)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 21), np.linspace(0, np.pi, 11))
    ball = 0.35 * np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    turn, along = np.meshgrid(np.linspace(0, 2 * np.pi, 13), (0.0, 1.0))

    def picture() -> None:
        figure = pyplot.figure()
        axes = figure.add_subplot(projection="3d")
        for atom in atoms:
            axes.plot_surface(*(ball + np.array(atom)[:, None, None]), color="gray")
        for a, b in np.array(atoms)[np.array(bonds)]:
            across = np.linalg.svd((b - a)[None])[2][1:] * 0.1
            round_about = across[0, :, None, None] * np.cos(turn) + across[1, :, None, None] * np.sin(turn)
            axes.plot_surface(*(a[:, None, None] + along * (b - a)[:, None, None] + round_about), color="silver")
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(f"{folder}/a.svg")
        pyplot.close(figure)

    return {"matplotlib, facets by their middles": seconds(picture)}


def vtk_molecule(path: Path) -> dict[str, float]:
    """Balls and rods of triangles, as pixels."""
    import vtk

    atoms, bonds = atoms_of(path)
    joined = vtk.vtkAppendPolyData()
    for atom in atoms:
        ball = vtk.vtkSphereSource()
        ball.SetCenter(*atom)
        ball.SetRadius(0.35)
        ball.SetThetaResolution(32)
        ball.SetPhiResolution(16)
        joined.AddInputConnection(ball.GetOutputPort())
    for a, b in bonds:
        line, rod = vtk.vtkLineSource(), vtk.vtkTubeFilter()
        line.SetPoint1(*atoms[a])
        line.SetPoint2(*atoms[b])
        rod.SetInputConnection(line.GetOutputPort())
        rod.SetRadius(0.1)
        rod.SetNumberOfSides(16)
        joined.AddInputConnection(rod.GetOutputPort())
    return {"vtk, pixels": seconds(_vtk_window(joined)[0].Render)}


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


def _vtk_window(joined: Any) -> tuple[Any, Any]:
    """A window of 1200 x 900 pixels that shows what was joined, and the actor in it."""
    import vtk

    mapper, actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
    mapper.SetInputConnection(joined.GetOutputPort())
    actor.SetMapper(mapper)
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1200, 900)
    window.AddRenderer(renderer)
    renderer.AddActor(actor)
    renderer.GetActiveCamera().SetPosition(*EYE)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    return window, actor


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
    window, actor = _vtk_window(joined)
    actor.GetProperty().SetColor(1, 1, 1)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().LightingOff()
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
    boxes = {"vectorplot": vectorplot_seconds, "matplotlib": matplotlib_seconds, "vtk": vtk_seconds}
    molecules = {
        "vectorplot": vectorplot_molecule, "xyzrender": xyzrender_molecule,
        "matplotlib": matplotlib_molecule, "vtk": vtk_molecule,
    }  # fmt: skip
    for name, measure in (molecules if scene.suffix == ".xyz" else boxes).items():
        if find_spec(name):
            for what, took in measure(scene).items():
                print(f"{what:<36} {took:8.3f} s", flush=True)
