"""Parts made by OpenCASCADE, for tests that have it: boxes with bores, fillets, lofts, threads, shells, sweeps."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

import vectorplot as vp


def occ(module: str, name: str) -> Any:
    """A name of a module of OpenCASCADE."""
    return getattr(import_module(f"OCP.{module}"), name)


def explored(shape: Any, kind: str) -> list[Any]:
    """The EDGEs, FACEs, WIREs or SOLIDs of a shape, each use of them."""
    topods = occ("TopoDS", "TopoDS")
    name = kind.capitalize()
    cast = getattr(topods, f"{name}_s", None) or getattr(topods, name)
    explorer = occ("TopExp", "TopExp_Explorer")(shape, getattr(occ("TopAbs", "TopAbs_ShapeEnum"), f"TopAbs_{kind}"))
    found = []
    while explorer.More():
        found.append(cast(explorer.Current()))
        explorer.Next()
    return found


def axes(x: float, y: float, z: float, way: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Any:
    return occ("gp", "gp_Ax2")(occ("gp", "gp_Pnt")(x, y, z), occ("gp", "gp_Dir")(*way))


def box(a: float, b: float, c: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeBox")(occ("gp", "gp_Pnt")(*at), a, b, c).Shape()


def rod(r: float, h: float, *at: float, way: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeCylinder")(axes(*(at or (0.0, 0.0, 0.0)), way), r, h).Shape()


def cone(r: float, s: float, h: float, *at: float) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeCone")(axes(*(at or (0.0, 0.0, 0.0))), r, s, h).Shape()


def ball(r: float, *at: float) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeSphere")(axes(*(at or (0.0, 0.0, 0.0))), r).Shape()


def ring(r: float, s: float, *at: float) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeTorus")(axes(*(at or (0.0, 0.0, 0.0))), r, s).Shape()


def cut(one: Any, *others: Any) -> Any:
    for other in others:
        one = occ("BRepAlgoAPI", "BRepAlgoAPI_Cut")(one, other).Shape()
    return one


def fused(one: Any, *others: Any) -> Any:
    for other in others:
        one = occ("BRepAlgoAPI", "BRepAlgoAPI_Fuse")(one, other).Shape()
    return one


def filleted(shape: Any, r: float, edges: Callable[[int], bool] = lambda _: True) -> Any:
    maker = occ("BRepFilletAPI", "BRepFilletAPI_MakeFillet")(shape)
    seen = list[Any]()
    for edge in explored(shape, "EDGE"):
        if not any(edge.IsSame(one) for one in seen):
            if edges(len(seen)):
                maker.Add(r, edge)
            seen.append(edge)
    return maker.Shape()


def chamfered(shape: Any, r: float, edges: Callable[[int], bool] = lambda _: True) -> Any:
    maker = occ("BRepFilletAPI", "BRepFilletAPI_MakeChamfer")(shape)
    seen = list[Any]()
    for edge in explored(shape, "EDGE"):
        if not any(edge.IsSame(one) for one in seen):
            if edges(len(seen)):
                maker.Add(r, edge)
            seen.append(edge)
    return maker.Shape()


def wire(points: list[tuple[float, float, float]], closed: bool = True) -> Any:
    maker = occ("BRepBuilderAPI", "BRepBuilderAPI_MakePolygon")()
    for point in points:
        maker.Add(occ("gp", "gp_Pnt")(*point))
    if closed:
        maker.Close()
    return maker.Wire()


def circle(r: float, *at: float, way: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Any:
    round_one = occ("gp", "gp_Circ")(axes(*at, way), r)
    edge = occ("BRepBuilderAPI", "BRepBuilderAPI_MakeEdge")(round_one).Edge()
    return occ("BRepBuilderAPI", "BRepBuilderAPI_MakeWire")(edge).Wire()


def spline(points: list[tuple[float, float, float]], periodic: bool = False) -> Any:
    try:
        array = occ("TColgp", "TColgp_HArray1OfPnt")(1, len(points))
    except (AttributeError, ModuleNotFoundError):
        array = occ("collections", "HArray1_gp_Pnt")(1, len(points))
    for number, point in enumerate(points, 1):
        array.SetValue(number, occ("gp", "gp_Pnt")(*point))
    maker = occ("GeomAPI", "GeomAPI_Interpolate")(array, periodic, 1e-9)
    maker.Perform()
    edge = occ("BRepBuilderAPI", "BRepBuilderAPI_MakeEdge")(maker.Curve()).Edge()
    return occ("BRepBuilderAPI", "BRepBuilderAPI_MakeWire")(edge).Wire()


def face(outline: Any) -> Any:
    return occ("BRepBuilderAPI", "BRepBuilderAPI_MakeFace")(outline).Face()


def prism(outline: Any, *way: float) -> Any:
    return occ("BRepPrimAPI", "BRepPrimAPI_MakePrism")(face(outline), occ("gp", "gp_Vec")(*way)).Shape()


def turned(outline: Any, angle: float = 2.0 * math.pi) -> Any:
    axis = occ("gp", "gp_Ax1")(occ("gp", "gp_Pnt")(0, 0, 0), occ("gp", "gp_Dir")(0, 0, 1))
    return occ("BRepPrimAPI", "BRepPrimAPI_MakeRevol")(face(outline), axis, angle).Shape()


def loft(*wires: Any, ruled: bool = False) -> Any:
    maker = occ("BRepOffsetAPI", "BRepOffsetAPI_ThruSections")(True, ruled)
    for one in wires:
        maker.AddWire(one)
    maker.Build()
    return maker.Shape()


def pipe(spine: Any, outline: Any) -> Any:
    return occ("BRepOffsetAPI", "BRepOffsetAPI_MakePipe")(spine, face(outline)).Shape()


def hollowed(shape: Any, thick: float, open_face: int) -> Any:
    try:
        faces = occ("TopTools", "TopTools_ListOfShape")()
    except AttributeError:
        faces = occ("collections", "List_TopoDS_Shape")()
    faces.Append(explored(shape, "FACE")[open_face])
    maker = occ("BRepOffsetAPI", "BRepOffsetAPI_MakeThickSolid")()
    maker.MakeThickSolidByJoin(shape, faces, -thick, 1e-4)
    return maker.Shape()


def moved(shape: Any, *by: float, turn: float = 0.0) -> Any:
    step, about = occ("gp", "gp_Trsf")(), occ("gp", "gp_Trsf")()
    step.SetTranslation(occ("gp", "gp_Vec")(*by))
    about.SetRotation(occ("gp", "gp_Ax1")(occ("gp", "gp_Pnt")(0, 0, 0), occ("gp", "gp_Dir")(0, 0, 1)), turn)
    return shape.Moved(occ("TopLoc", "TopLoc_Location")(step.Multiplied(about)))


def compound(*shapes: Any) -> Any:
    builder, whole = occ("BRep", "BRep_Builder")(), occ("TopoDS", "TopoDS_Compound")()
    builder.MakeCompound(whole)
    for one in shapes:
        builder.Add(whole, one)
    return whole


def square(a: float, z: float, turn: float = 0.0) -> Any:
    corners = [(turn + math.pi / 4 + k * math.pi / 2) for k in range(4)]
    return wire([(a * math.cos(t), a * math.sin(t), z) for t in corners])


def star(n: int, r: float, s: float, z: float = 0.0) -> list[tuple[float, float, float]]:
    return [
        ((r if k % 2 else s) * math.cos(math.pi * k / n), (r if k % 2 else s) * math.sin(math.pi * k / n), z)
        for k in range(2 * n)
    ]


def thread(r: float, pitch: float, turns: float, depth: float) -> Any:
    """A rod with a ridge along a helix."""
    cylinder = occ("Geom", "Geom_CylindricalSurface")(occ("gp", "gp_Ax3")(axes(0, 0, 0)), r)
    way = occ("gp", "gp_Dir2d")(2 * math.pi, pitch)
    line = occ("Geom2d", "Geom2d_Line")(occ("gp", "gp_Pnt2d")(0.0, 0.0), way)
    length = turns * math.hypot(2 * math.pi, pitch)
    edge = occ("BRepBuilderAPI", "BRepBuilderAPI_MakeEdge")(line, cylinder, 0.0, length).Edge()
    occ("BRepLib", "BRepLib").BuildCurves3d_s(edge)
    spine = occ("BRepBuilderAPI", "BRepBuilderAPI_MakeWire")(edge).Wire()
    half = 0.3 * pitch
    outline = wire([(r - 0.1, 0, -half), (r + depth, 0, -half / 3), (r + depth, 0, half / 3), (r - 0.1, 0, half)])
    maker = occ("BRepOffsetAPI", "BRepOffsetAPI_MakePipeShell")(spine)
    maker.SetMode(True)
    maker.Add(outline)
    maker.Build()
    maker.MakeSolid()
    return fused(rod(r, pitch * (turns + 2), 0, 0, -pitch), maker.Shape())


def plate_with_bores(n: int) -> Any:
    plate = box(12.0 * n, 36.0, 8.0)
    return cut(plate, *(rod(3.0, 10.0, 12.0 * k + 6.0, y, -1.0) for k in range(n) for y in (8.0, 18.0, 28.0)))


def flange() -> Any:
    disc = fused(rod(40, 8), rod(18, 30))
    bores = [rod(4, 12, 30 * math.cos(k * math.pi / 3), 30 * math.sin(k * math.pi / 3), -1) for k in range(6)]
    return filleted(cut(disc, rod(11, 40, 0, 0, -1), *bores), 1.0, lambda k: k in (0, 3))


def bracket() -> Any:
    angle = fused(box(40, 30, 5), box(5, 30, 40))
    return cut(
        filleted(angle, 2.0, lambda k: k % 5 == 0), rod(5, 20, 25, 15, -5), rod(5, 20, -5, 15, 25, way=(1, 0, 0))
    )


WAVES = [(k * math.pi / 4, 12.0 + 5.0 * (k % 2)) for k in range(8)]

PARTS: dict[str, Callable[[], Any]] = {
    "box": lambda: box(40, 30, 20),
    "box with a bore": lambda: cut(box(40, 30, 20), rod(7, 30, 20, 15, -1)),
    "rounded box": lambda: filleted(box(40, 30, 20), 4),
    "box, some edges rounded": lambda: filleted(box(40, 30, 20), 3, lambda k: k in (0, 2, 5, 8)),
    "chamfered box": lambda: chamfered(box(40, 30, 20), 3),
    "rod": lambda: rod(10, 40),
    "cone": lambda: cone(15, 0, 30),
    "frustum": lambda: cone(15, 6, 30),
    "ball": lambda: ball(15),
    "ring": lambda: ring(20, 6),
    "tee": lambda: fused(rod(10, 60, 0, 0, -30), rod(6, 30, 0, 0, 0, way=(1, 0, 0))),
    "tee of equal rods": lambda: fused(rod(10, 60, 0, 0, -30), rod(10, 30, 0, 0, 0, way=(1, 0, 0))),
    "bored ball": lambda: cut(ball(20), rod(8, 50, 0, 0, -25)),
    "ball on a plate": lambda: fused(box(50, 50, 6, (-25, -25, -3)), ball(14, 0, 0, 10)),
    "rounded tee": lambda: filleted(
        fused(rod(12, 50, 0, 0, -25), rod(6, 30, 0, 0, 0, way=(1, 0, 0))), 2, lambda k: k == 3
    ),
    "flange": flange,
    "bracket": bracket,
    "plate with bores": lambda: plate_with_bores(6),
    "hollow box": lambda: hollowed(filleted(box(40, 30, 25), 4, lambda k: k in (0, 2, 4, 6)), 2, 0),
    "shelled box": lambda: hollowed(box(40, 30, 25), 3, 5),
    "loft of squares": lambda: loft(square(15, 0), square(8, 20, 0.6), square(14, 40, 1.2)),
    "ruled loft": lambda: loft(square(15, 0), square(12, 30, 0.5), ruled=True),
    "loft to a circle": lambda: loft(circle(15, 0, 0, 0), circle(6, 3, 0, 20), circle(11, 0, 0, 40)),
    "prism of a spline": lambda: prism(
        spline([(r * math.cos(t), r * math.sin(t), 0) for t, r in WAVES], True),
        0, 0, 20,
    ),
    "star": lambda: prism(wire(star(7, 20, 11)), 0, 0, 8),
    "gear": lambda: cut(prism(wire(star(20, 24, 20)), 0, 0, 8), rod(7, 10, 0, 0, -1)),
    "vase": lambda: turned(wire([(0, 0, 0), (10, 0, 0), (14, 0, 12), (6, 0, 26), (9, 0, 32), (0, 0, 32)])),
    "turned spline": lambda: occ("BRepPrimAPI", "BRepPrimAPI_MakeRevol")(
        spline([(8, 0, 0), (15, 0, 10), (6, 0, 22), (10, 0, 32)]),
        occ("gp", "gp_Ax1")(occ("gp", "gp_Pnt")(0, 0, 0), occ("gp", "gp_Dir")(0, 0, 1)),
    ).Shape(),
    "half turned": lambda: turned(wire([(6, 0, 0), (16, 0, 0), (16, 0, 5), (9, 0, 20), (6, 0, 20)]), 1.6 * math.pi),
    "bent pipe": lambda: pipe(
        spline([(0, 0, 0), (0, 0, 20), (15, 0, 35), (35, 10, 35)]), circle(4, 0, 0, 0)
    ),
    "thread": lambda: thread(8, 4, 3, 1.5),
    "two solids": lambda: compound(box(10, 10, 10), moved(filleted(box(10, 10, 10), 2), 15, 0, 0, turn=0.4)),
}  # fmt: skip
"""Parts by what they are."""


def write_step(shape: Any, path: Path) -> Path:
    """A file that another program might have written."""
    controller = occ("STEPControl", "STEPControl_Writer")()
    controller.Transfer(shape, occ("STEPControl", "STEPControl_StepModelType").STEPControl_AsIs)
    controller.Write(str(path))
    return path


def document() -> Any:
    """An empty document for assemblies."""
    text = occ("TCollection", "TCollection_ExtendedString")
    made = occ("TDocStd", "TDocStd_Document")(text("BinXCAF"))
    occ("XCAFApp", "XCAFApp_Application").GetApplication_s().NewDocument(text("BinXCAF"), made)
    return made


class Assembly:
    """An assembly that is put together, and written as a STEP file."""

    def __init__(self) -> None:
        self.document = document()
        tools = occ("XCAFDoc", "XCAFDoc_DocumentTool")
        self.shapes = tools.ShapeTool_s(self.document.Main())
        self.colours = tools.ColorTool_s(self.document.Main())

    def named(self, label: Any, name: str) -> Any:
        """A label with a name."""
        text = occ("TCollection", "TCollection_ExtendedString")(name)
        occ("TDataStd", "TDataStd_Name").Set_s(label, text)
        return label

    def coloured(self, label: Any, red: float, green: float, blue: float, opacity: float = 1.0) -> Any:
        """A label with a colour."""
        srgb = occ("Quantity", "Quantity_TypeOfColor").Quantity_TOC_sRGB
        rgba = occ("Quantity", "Quantity_ColorRGBA")(occ("Quantity", "Quantity_Color")(red, green, blue, srgb), opacity)
        self.colours.SetColor(label, rgba, occ("XCAFDoc", "XCAFDoc_ColorType").XCAFDoc_ColorSurf)
        return label

    def made_of(self, label: Any, name: str) -> Any:
        """A label with a material."""
        text, materials = occ("TCollection", "TCollection_HAsciiString"), occ("XCAFDoc", "XCAFDoc_DocumentTool")
        said = text(name), text(""), 7.85, text("g/cm3"), text("POSITIVE_RATIO_MEASURE")
        materials.MaterialTool_s(self.document.Main()).SetMaterial(label, *said)
        return label

    def part(self, name: str, shape: Any) -> Any:
        """A part with a name."""
        return self.named(self.shapes.AddShape(shape, False), name)

    def group(self, name: str, *parts: tuple[Any, tuple[float, float, float]]) -> Any:
        """An assembly of parts, each at a place."""
        label = self.named(self.shapes.NewShape(), name)
        for part, (x, y, z) in parts:
            step = occ("gp", "gp_Trsf")()
            step.SetTranslation(occ("gp", "gp_Vec")(x, y, z))
            self.shapes.AddComponent(label, part, occ("TopLoc", "TopLoc_Location")(step))
        return label

    def write(self, path: Path) -> Path:
        """The file."""
        self.shapes.UpdateAssemblies()
        writer = occ("STEPCAFControl", "STEPCAFControl_Writer")()
        writer.Transfer(self.document)
        writer.Write(str(path))
        return path


def bearing(path: Path) -> Path:
    """The bearing that the page on parts of CAD systems shows, as a STEP file."""
    foot = filleted(box(120, 40, 14, (-60, -20, 0)), 8, lambda k: k in (0, 2, 4, 6))
    house = cut(fused(foot, rod(28, 40, 0, -20, 40, way=(0, 1, 0)), box(56, 40, 40, (-28, -20, 0))))
    slots = [rod(5.5, 20, x, 0, -1) for x in (-44, 44)]
    body = cut(house, rod(18, 50, 0, -25, 40, way=(0, 1, 0)), *slots)
    bush = cut(rod(18, 44, 0, -22, 40, way=(0, 1, 0)), rod(13, 60, 0, -30, 40, way=(0, 1, 0)))
    shaft = chamfered(rod(13, 120, 0, -60, 40, way=(0, 1, 0)), 2)
    hexagon = [(9 * math.cos(k * math.pi / 3), 9 * math.sin(k * math.pi / 3), 14) for k in range(6)]
    bolt = fused(rod(5.5, 24, 0, 0, -10), prism(wire(hexagon), 0, 0, 7))
    whole = Assembly()
    house_part = whole.coloured(whole.part("housing", body), 0.35, 0.5, 0.6)
    bush_part = whole.coloured(whole.part("bush", bush), 0.8, 0.6, 0.2)
    shaft_part = whole.coloured(whole.part("shaft", shaft), 0.75, 0.75, 0.78)
    bolt_part = whole.coloured(whole.part("bolt", bolt), 0.3, 0.3, 0.32)
    turning = whole.group("shaft in bush", (bush_part, (0, 0, 0)), (shaft_part, (0, 0, 0)))
    whole.group(
        "bearing", (house_part, (0, 0, 0)), (turning, (0, 0, 0)), (bolt_part, (-44, 0, 0)), (bolt_part, (44, 0, 0))
    )
    return whole.write(path)


# Rays of OpenCASCADE as oracles.


def samples(drawing: vp.Drawing) -> list[tuple[np.ndarray, bool]]:
    """Places in the middles of some segments of every line that is longer than 2 mm, and whether they are visible."""
    found = []
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in range(len(paths)):
                inside = slice(int(paths.offsets[k]), int(paths.offsets[k + 1]))
                flat, points = paths.points[inside], paths.points3d[inside]
                if np.hypot(*np.diff(flat, axis=0).T).sum() < 2.0:
                    continue
                for at in np.unique(np.linspace(0, len(points) - 2, 4).round().astype(int)).tolist():
                    found.append((0.5 * (points[at] + points[at + 1]), bool(paths.hidden_by[k] == 0)))
    return found


def agrees(shape: object, place: np.ndarray, way: np.ndarray, seen: bool, extent: float) -> bool:
    """Whether a ray from a place, or from one within the tolerance beside it, meets the shape as it must."""
    rays = occ("IntCurvesFace", "IntCurvesFace_ShapeIntersector")()
    rays.Load(shape, 1e-7)
    one = np.cross(way, (0.3, 0.5, 0.8))
    one /= np.linalg.norm(one)
    other, near = np.cross(way, one), 5e-4 * extent
    for x, y in ((0, 0), *((x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y)):
        start = place + near * (x * one + y * other)
        line = occ("gp", "gp_Lin")(occ("gp", "gp_Pnt")(*start.tolist()), occ("gp", "gp_Dir")(*way.tolist()))
        # A place on a chord is a little inside: what the ray leaves again at once is its own surface.
        rays.Perform(line, (0.03 if seen else 4e-4) * extent, 1e3 * extent)
        if (rays.NbPnt() == 0) == seen:
            return True
    return False
