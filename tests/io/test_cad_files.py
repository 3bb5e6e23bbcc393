"""Parts of CAD systems: edges and normals of bodies as they are told, and files, where OpenCASCADE is there."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from support import cad_parts
from support.cad_parts import PARTS, Assembly, agrees, explored, occ, samples, write_step

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.io import cad_files
from vectorplot.io.anything import scene_of
from vectorplot.io.cad_files import CadBody, EdgeKind, body_item, cad_scene, edge_kinds
from vectorplot.scene.scene import Scene
from vectorplot.words import LineKind

N, HIGH = 24, 2.0
UP = np.array([0.0, 0.0, HIGH])


def strip(angles: np.ndarray, radius: float, middle: tuple[float, float] = (0.0, 0.0)) -> dict[str, np.ndarray]:
    """A part of a cylinder about a vertical axis, from angle to angle, its points at the bottom and then at the top."""
    around = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    low = radius * around + (*middle, 0.0)
    count, k = len(angles), np.arange(len(angles) - 1)
    triangles = [np.stack([k, k + 1, count + k], axis=1), np.stack([k + 1, count + k + 1, count + k], axis=1)]
    return {
        "points": np.concatenate([low, low + UP]),
        "normals": np.concatenate([around, around]),
        "bending": np.full(2 * count, -0.5 / radius),
        "triangles": np.concatenate(triangles),
    }


def wall(start: tuple[float, float], end: tuple[float, float]) -> dict[str, np.ndarray]:
    """A vertical rectangle, seen from its right."""
    low = np.array([(*start, 0.0), (*end, 0.0)])
    way = low[1] - low[0]
    normal = np.array([way[1], -way[0], 0.0]) / math.hypot(way[0], way[1])
    return {
        "points": np.concatenate([low, low + UP]),
        "normals": np.tile(normal, (4, 1)),
        "bending": np.zeros(4),
        "triangles": np.array([(0, 1, 2), (1, 3, 2)]),
    }


def lid(rim: np.ndarray, up: bool) -> dict[str, np.ndarray]:
    """A convex polygon, its points once around, counter-clockwise from above."""
    k = np.arange(1, len(rim) - 1)
    fan = np.stack([0 * k, k, k + 1], axis=1)
    return {
        "points": rim,
        "normals": np.tile([0.0, 0.0, 1.0 if up else -1.0], (len(rim), 1)),
        "bending": np.zeros(len(rim)),
        "triangles": fan if up else fan[:, ::-1],
    }


def body(*sides: dict[str, np.ndarray]) -> CadBody:
    """The body of faces one beside the other all around, with a bottom and a top; edges 0 to s-1 are between sides,
    then come s at the bottom and s at the top."""
    rims = [side["points"][: len(side["points"]) // 2] for side in sides]
    outline = np.concatenate([rim[:-1] for rim in rims])
    faces = [*sides, lid(outline, up=False), lid(outline + UP, up=True)]
    first = ragged.offsets([len(face["points"]) for face in faces])
    uses: list[tuple[int, int, np.ndarray]] = []
    start, many, total = 0, len(sides), len(outline)
    for k, side in enumerate(sides):
        half = len(side["points"]) // 2
        uses.append((k, k, first[k] + np.array([half - 1, 2 * half - 1])))
        uses.append(((k - 1) % many, k, first[k] + np.array([0, half])))
        along = (start + np.arange(half)) % total
        for level, step in ((0, 0), (1, half)):
            edge = (1 + level) * many + k
            uses.append((edge, k, first[k] + step + np.arange(half)))
            uses.append((edge, many + level, first[many + level] + along))
        start += half - 1
    counts = [len(face["triangles"]) for face in faces]
    owner = ragged.owner(counts)
    joined = {name: np.concatenate([face[name] for face in faces]) for name in ("points", "normals", "bending")}
    triangles = np.concatenate([face["triangles"] for face in faces]) + first[owner][:, None]
    flat = np.array([not face["bending"].any() for face in faces])
    return CadBody(
        **joined, triangles=triangles, face=owner, flat=flat, shares=np.full((len(faces), 4), np.nan),
        nodes=np.concatenate([nodes for _, _, nodes in uses]),
        offsets=ragged.offsets([len(nodes) for _, _, nodes in uses]),
        edge=np.array([edge for edge, _, _ in uses]), user=np.array([face for _, face, _ in uses]),
    )  # fmt: skip


HALVES = [strip(np.linspace(a, a + math.pi, N), 1.0) for a in (0.0, math.pi)]
STADIUM = [
    strip(np.linspace(-math.pi / 2, math.pi / 2, N), 1.0, (2.0, 0.0)), wall((2.0, 1.0), (-2.0, 1.0)),
    strip(np.linspace(math.pi / 2, 1.5 * math.pi, N), 1.0, (-2.0, 0.0)), wall((-2.0, -1.0), (2.0, -1.0)),
]  # fmt: skip


def drawn_kinds(drawing: vp.Drawing) -> dict[str, float]:
    """The length in mm of the lines of every kind, what closed ones return by left out."""
    found: dict[str, float] = {}
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in range(len(paths)):
                points = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
                steps = np.diff(np.concatenate([points, points[:1]]) if paths.closed[k] else points, axis=0)
                kind = LineKind(int(paths.kind[k])).word
                found[kind] = found.get(kind, 0.0) + float(np.hypot(*steps.T).sum())
    return found


def test_halves_of_a_cylinder_meet_in_seams_and_a_flat_side_goes_on_in_a_tangent_edge():
    assert edge_kinds(body(*HALVES)).tolist() == 2 * [EdgeKind.SEAM] + 4 * [EdgeKind.SHARP]
    assert edge_kinds(body(*STADIUM)).tolist() == 4 * [EdgeKind.TANGENT] + 8 * [EdgeKind.SHARP]


def test_a_fold_of_three_degrees_is_sharp_and_one_of_half_a_degree_is_none():
    for angle, kind in ((3.0, EdgeKind.SHARP), (0.5, EdgeKind.SEAM)):
        turn = math.radians(angle)
        corners = [(0.0, 0.0), (1.0, 0.0), (1.0 + math.cos(turn), math.sin(turn)), (1.0, 3.0)]
        walls = [wall(one, other) for one, other in zip(corners, corners[1:] + corners[:1], strict=True)]
        assert edge_kinds(body(*walls))[0] == kind


def test_another_radius_on_the_other_side_is_a_tangent_edge():
    large = strip(np.linspace(0.0, math.pi, N), 2.0)
    small = strip(np.linspace(math.pi, 1.5 * math.pi, N), 1.0, (-1.0, 0.0))
    rest = wall((-1.0, -1.0), (2.0, 0.0))
    assert edge_kinds(body(large, small, rest)).tolist()[:2] == [EdgeKind.TANGENT, EdgeKind.SHARP]


def test_bodies_close_and_only_their_own_edges_are_listed():
    for sides, tangent in ((HALVES, 0), (STADIUM, 4)):
        item = body_item("rod", body(*sides))
        assert item.mesh.is_closed and item.normals is not None
        assert np.allclose(np.linalg.norm(item.normals.at_vertices, axis=1), 1.0)
        assert len(item.tangent_edges) == tangent
        rims = sum(len(side["points"]) - 2 for side in sides)
        assert len(item.drawn_edges) == rims
        moved = item.transformed(np.diag([2.0, 1.0, 1.0, 1.0]))
        assert np.allclose(moved.tangent_edges, item.tangent_edges * (2.0, 1.0, 1.0))


def test_the_contour_of_a_rod_is_where_its_cylinder_turns_away_not_where_triangles_do():
    scene, eye = vp.Scene((body_item("rod", body(*HALVES)),)), np.array([3.0, -7.0, 9.0])
    drawing = vp.draw(scene, vp.Camera(tuple(eye), (0.0, 0.0, 1.0)))
    upright = []
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero(paths.kind == LineKind.CONTOUR):
                points = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                steep = np.abs(np.diff(points[:, 2])) > 0.1
                upright += [*points[1:][steep], *points[:-1][steep]]
    # x^2 + y^2 = 1 turns away from the eye where x ex + y ey = 1; triangles do so at multiples of 180/23 degrees.
    assert len(upright) >= 4
    assert np.abs(np.array(upright)[:, :2] @ eye[:2] - 1.0).max() < 0.05
    assert not {"tangent", "edges"} & set(drawn_kinds(drawing))


def test_tangent_edges_have_a_layer_and_go_where_they_are_not_asked_for():
    scene, camera = vp.Scene((body_item("stadium", body(*STADIUM)),)), vp.Camera((4.0, -9.0, 7.0), (0.0, 0.0, 1.0))
    drawing = vp.draw(scene, camera)
    layer = {layer.name: layer for layer in drawing.layers}["tangent"]
    assert layer.pen.width_mm == 0.13 and layer.strokes
    assert drawn_kinds(drawing)["tangent"] > 10.0
    assert "tangent" not in drawn_kinds(vp.draw(scene, camera, lines=("contour", "crease", "boundary")))
    only = drawn_kinds(vp.draw(scene, camera, lines="tangent"))
    assert set(only) == {"tangent"} and only["tangent"] > 10.0


def test_sharp_edges_are_sharp_at_both_ends_of_the_shades():
    item = body_item("rod", body(*HALVES))
    from vectorplot.shading.facet_resolution import FacetedScene

    known = FacetedScene.of_meshes(vp.Scene((item,))).normals[0]
    assert known is not None and known.at_corners is not None
    upward = np.abs(known.at_corners[:, 2])
    assert set(np.unique(upward.round(9))) == {0.0, 1.0}


def test_a_cut_takes_contours_and_tangent_edges_away():
    scene, camera = vp.Scene((body_item("stadium", body(*STADIUM)),)), vp.Camera((4.0, -9.0, 7.0), (0.0, 0.0, 1.0))
    whole, half = (vp.draw(one, camera, hidden="solid") for one in (scene, vp.cut(scene, "x>0")))
    for drawing, least in ((whole, -3.0), (half, -3.0)):
        points = np.concatenate([paths.points3d for layer in drawing.layers for paths in layer.strokes if len(paths)])
        assert points[:, 0].min() == pytest.approx(least, abs=0.01)
        assert points[:, 0].max() == pytest.approx(3.0 if drawing is whole else 0.0, abs=0.01)
    lengths = drawn_kinds(whole)["tangent"], drawn_kinds(half)["tangent"]
    assert lengths[1] < lengths[0]


@pytest.mark.parametrize("name", ["part.step", "part.STP", "part.igs", "part.iges", "part.brep"])
def test_without_the_extra_one_line_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str):
    for module in [known for known in sys.modules if known.split(".")[0] == "OCP"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "OCP", None)
    path = tmp_path / name
    path.write_text("ISO-10303-21;")
    with pytest.raises(InputError) as error:
        vp.read(path)
    assert str(error.value).startswith(f"{path}: a file of a CAD system needs OpenCASCADE")
    assert "pip install '.[step]'" in str(error.value)


def test_shapes_of_other_libraries_are_looked_for_only_where_opencascade_is(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "OCP", None)
    with pytest.raises(TypeError, match="a shape of build123d or CadQuery"):
        scene_of(object())


# With OpenCASCADE.


@pytest.fixture(scope="module")
def opencascade() -> None:
    pytest.importorskip("OCP")


@pytest.mark.slow
@pytest.mark.usefixtures("opencascade")
@pytest.mark.parametrize("name", list(PARTS))
def test_parts_are_read_whole_and_rays_see_what_is_drawn(tmp_path: Path, name: str):
    shape = PARTS[name]()
    scene = vp.read(write_step(shape, tmp_path / "part.step"))
    if name != "turned spline":
        assert all(item.mesh.is_closed for item in scene.items)
    extent = float(np.linalg.norm(np.ptp(scene.bounds, axis=0)))
    for eye in ((0.3, -1.0, 0.17), (-0.6, 0.5, -0.7)):
        way = np.array(eye) / np.linalg.norm(eye)
        middle = scene.bounds.mean(axis=0)
        camera = vp.Camera(tuple(middle + 20.0 * extent * way), tuple(middle), parallel=True)
        places = samples(vp.draw(scene, camera, hidden="solid"))
        wrong = [place for place, seen in places if not agrees(shape, place, way, seen, extent)]
        assert not wrong, wrong[:3]


@pytest.fixture(scope="module")
def assembly(opencascade: None, tmp_path_factory: pytest.TempPathFactory) -> Scene:
    whole = Assembly()
    plate = whole.coloured(whole.part("plate", cad_parts.box(40, 30, 4)), 0.2, 0.4, 0.8)
    pin = whole.coloured(whole.part("pin", cad_parts.rod(3, 10)), 0.8, 0.2, 0.2, 0.5)
    both = whole.part("both", cad_parts.compound(cad_parts.box(2, 2, 2), cad_parts.box(2, 2, 2, (5, 0, 0))))
    pair = whole.group("pair", (pin, (10, 10, 4)), (pin, (30, 10, 4)))
    whole.group("whole", (plate, (0, 0, 0)), (pair, (0, 0, 0)), (pair, (0, 10, 0)), (both, (0, 0, 40)))
    return vp.read(whole.write(tmp_path_factory.mktemp("cad") / "whole.step"))


def test_assemblies_are_items_with_names_colours_and_groups(assembly: Scene):
    said = [(item.name, item.colour, item.group, round(item.material.opacity, 2)) for item in assembly.items]
    assert said == [
        ("plate", "#3366cc", "", 1.0),
        ("pin", "#cc3333", "pair", 0.5), ("pin 2", "#cc3333", "pair", 0.5),
        ("pin 3", "#cc3333", "pair 2", 0.5), ("pin 4", "#cc3333", "pair 2", 0.5),
        ("both", "gray", "both", 1.0), ("both 2", "gray", "both", 1.0),
    ]  # fmt: skip
    assert np.allclose(assembly.items[3].mesh.bounds, [(7, 17, 4), (13, 23, 14)], atol=0.02)


def test_materials_of_parts_are_a_column_of_their_list(opencascade: None, tmp_path: Path):
    whole = Assembly()
    plate = whole.made_of(whole.part("plate", cad_parts.box(40, 30, 4)), "S235JR")
    pins = [whole.made_of(whole.part(f"pin {k}", cad_parts.rod(k, 9)), said) for k, said in ((2, "C45"), (3, "brass"))]
    mixed = whole.group("pins", *((pin, (10.0, 10.0 * k, 4.0)) for k, pin in enumerate(pins)))
    bare = whole.part("cap", cad_parts.box(2, 2, 2))
    whole.group("whole", (plate, (0, 0, 0)), (mixed, (0, 0, 0)), (bare, (0, 0, 9)))
    scene = vp.read(whole.write(tmp_path / "whole.step"))
    # Of what is of several materials, or of none that is known, nothing is said.
    assert scene.sheet is not None and scene.sheet.made_of == (("plate", "S235JR"),)
    sheet = vp.technical_sheet(scene, parts_list=True, text="real")
    strings = [string for layer in sheet.layers for texts in layer.texts for string in texts.strings]
    assert {"plate", "S235JR", "pins", "cap"} <= set(strings)
    assert vp.read(write_step(cad_parts.box(1, 1, 1), tmp_path / "box.step")).sheet is None


@pytest.mark.slow
def test_parts_measure_what_their_surfaces_do(opencascade: None, tmp_path: Path):
    whole = Assembly()
    disc = whole.part("disc", cad_parts.rod(75, 14))
    whole.group("whole", (disc, (0, 0, 0)), (whole.part("pin", cad_parts.rod(8, 30)), (20, 20, 14)))
    scene = vp.read(whole.write(tmp_path / "whole.step"))
    assert np.abs(scene.bounds - [(-75, -75, 0), (75, 75, 44)]).max() < 1e-6
    pin = vp.read(
        write_step(cad_parts.moved(cad_parts.rod(8, 30, way=(1, 0, 0)), 0, 0, 0, turn=0.7), tmp_path / "p.step")
    )
    wide, high = 30 * math.cos(0.7) + 16 * math.sin(0.7), 30 * math.sin(0.7) + 16 * math.cos(0.7)
    assert np.abs(np.ptp(pin.bounds, axis=0) - [wide, high, 16]).max() < 1e-6
    for parts in ("triangles", "exact"):
        sheet = vp.technical_sheet(vp.read(tmp_path / "whole.step", parts=parts), dimensions=True, text="real")
        strings = [string for layer in sheet.layers for texts in layer.texts for string in texts.strings]
        assert strings.count("150") == 2 and strings.count("44") == 1


@pytest.mark.slow
def test_sheets_show_no_lines_in_which_parts_only_touch(opencascade: None):
    plate = cad_parts.cut(cad_parts.box(40, 40, 30), cad_parts.rod(8, 60, 20, 20, -5))
    scene = scene_of({"plate": plate, "pin": cad_parts.moved(cad_parts.rod(8, 40), 20, 20, -5)})
    sheet = vp.technical_sheet(scene, views="front", scale="1:1", breakout="front:20,20,15,6")
    kinds = {layer.name for layer in sheet.layers if any(len(paths) for paths in layer.strokes)}
    assert "intersection" not in kinds and {"contour", "hatch", "thin"} <= kinds
    hidden = next(layer for layer in sheet.layers if layer.name == "hidden")
    assert sum(len(paths) for paths in hidden.strokes) < 40


def test_rims_of_bores_with_pins_in_them_are_whole(opencascade: None):
    plate = cad_parts.cut(cad_parts.box(40, 40, 10), cad_parts.rod(8, 20, 20, 20, -5))
    scene = scene_of({"plate": plate, "pin": cad_parts.moved(cad_parts.rod(8, 30), 20, 20, 0, turn=0.05)})
    assert [item.name for item in scene.items] == ["plate", "pin"]
    camera = vp.Camera((120.0, -160.0, 150.0), (20.0, 20.0, 10.0))
    rim = []
    for layer in vp.draw(scene, camera).layers:
        for paths in layer.strokes:
            for k in range(len(paths)):
                points = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                middle = 0.5 * (points[1:] + points[:-1])
                on = (np.abs(middle[:, 2] - 10.0) < 0.01) & (np.abs(np.hypot(*(middle[:, :2] - 20.0).T) - 8.0) < 0.02)
                if on.all():
                    rim.append(float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum()))
    # The half that looks at the eye is one stroke, and no row of dashes.
    assert max(rim) > 0.95 * 8.0 * math.pi


@pytest.mark.slow
def test_iges_and_brep_give_the_same_drawing_as_step(opencascade: None, tmp_path: Path):
    shape = PARTS["rounded tee"]()
    write_step(shape, tmp_path / "part.step")
    occ("BRepTools", "BRepTools").Write_s(shape, str(tmp_path / "part.brep"))
    writer = occ("IGESControl", "IGESControl_Writer")("MM", 0)
    writer.AddShape(shape)
    writer.ComputeModel()
    writer.Write(str(tmp_path / "part.igs"))
    camera = vp.Camera((200.0, -300.0, 220.0), (0.0, 0.0, 0.0))
    lengths = [
        drawn_kinds(vp.draw(vp.read(tmp_path / name), camera)) for name in ("part.step", "part.brep", "part.igs")
    ]
    for other in lengths[1:]:
        assert set(other) == set(lengths[0])
        assert all(other[kind] == pytest.approx(lengths[0][kind], rel=0.01) for kind in other)


def test_bad_files_are_told_in_one_line(opencascade: None, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    for name, content, cause in (
        ("a.step", "", "the file is empty"),
        ("b.step", "ISO-10303-21;\nHEADER;", "not a STEP file that OpenCASCADE can read"),
        ("c.brep", "hello", "not a BREP file"),
        ("e.igs", "hello", "it holds no"),
    ):
        path = tmp_path / name
        path.write_text(content)
        with pytest.raises(InputError) as error:
            vp.read(path)
        assert str(error.value).startswith(f"{path}: {cause}")
    occ("BRepTools", "BRepTools").Write_s(cad_parts.circle(3, 0, 0, 0), str(tmp_path / "f.brep"))
    with pytest.raises(InputError, match="it holds no faces"):
        vp.read(tmp_path / "f.brep")
    with pytest.raises(InputError, match="expected a positive part"):
        cad_scene(tmp_path / "f.brep", 0.0)
    # What OpenCASCADE says itself would stand in a picture that goes to standard output.
    assert capfd.readouterr().out == ""


def test_a_finer_tolerance_makes_shorter_chords(opencascade: None, tmp_path: Path):
    path = tmp_path / "rod.brep"
    occ("BRepTools", "BRepTools").Write_s(cad_parts.rod(10, 40), str(path))
    count = [len(vp.read(path, tolerance=tolerance).items[0].drawn_edges) for tolerance in (4e-5, 1e-5)]
    # The sagitta of a chord is a quarter where there are twice as many.
    assert count[1] == pytest.approx(2 * count[0], rel=0.1)


def test_objects_stay_as_they_were(opencascade: None):
    shape = cad_parts.rod(10, 40)
    scene = scene_of([shape, cad_parts.ball(3, 40, 0, 0)])
    assert len(scene.items) == 2 and all(item.mesh.is_closed for item in scene.items)
    location = occ("TopLoc", "TopLoc_Location")()
    face = explored(shape, "FACE")[0]
    assert occ("BRep", "BRep_Tool").Triangulation_s(face, location) is None
    with pytest.raises(InputError, match="holds no faces"):
        scene_of(cad_parts.circle(3, 0, 0, 0))


def test_errors_of_opencascade_are_told_in_one_line(opencascade: None, monkeypatch: pytest.MonkeyPatch):
    def fails(*_: object) -> None:
        raise occ("Standard", "Standard_Failure")("no such triangle")

    monkeypatch.setattr(cad_files, "_divide", fails)
    with pytest.raises(InputError, match=r"^TopoDS_\w+: OpenCASCADE cannot divide it: Standard_Failure"):
        scene_of(cad_parts.rod(10, 40))


def test_open_shapes_are_divided_once(opencascade: None, monkeypatch: pytest.MonkeyPatch):
    ways, divide = [], cad_files._divide
    monkeypatch.setattr(cad_files, "_divide", lambda *of: (ways.append(of), divide(*of)))
    (face, *_) = explored(cad_parts.rod(10, 40), "FACE")
    (item,) = scene_of(face).items
    assert len(ways) == 1 and not item.mesh.is_closed


def test_the_contour_of_a_ball_is_exact_though_its_triangles_are_not(opencascade: None):
    eye = np.array([60.0, -90.0, 70.0])
    drawing = vp.draw(cad_parts.ball(15.0), vp.Camera(tuple(eye), (0.0, 0.0, 0.0)))
    points = np.concatenate([paths.points3d for layer in drawing.layers for paths in layer.strokes])
    away = eye - points
    off = np.linalg.norm(np.cross(points, away), axis=1) / np.linalg.norm(away, axis=1) - 15.0
    assert len(points) > 100 and np.abs(off).max() < 2e-5 * 15.0


def test_the_command_reads_parts(opencascade: None, tmp_path: Path):
    path = write_step(PARTS["box with a bore"](), tmp_path / "part.step")
    out = tmp_path / "part.svg"
    assert run(["draw", str(path), "-o", str(out), "--quiet", "--curves", "arcs"]) == 0
    assert " A" in out.read_text()


@pytest.mark.slow
def test_scene_files_include_parts(opencascade: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    whole = Assembly()
    plate = whole.made_of(whole.coloured(whole.part("plate", cad_parts.box(40, 30, 4)), 0.2, 0.4, 0.8), "S235JR")
    whole.group("whole", (plate, (0, 0, 0)), (whole.part("pin", cad_parts.rod(5, 9)), (20, 15, 4)))
    whole.write(tmp_path / "whole.step")
    told = 'include "whole.step" translation 0 0 10\ndimension from 0 0 10 to 40 0 10 offset 0 0 -8\n'
    (tmp_path / "whole.scene").write_text(told + 'sheet field "A" "B"', encoding="utf-8")
    scene = vp.read(tmp_path / "whole.scene")
    assert [item.name for item in scene.items[:2]] == ["plate", "pin"] and scene.items[0].colour == "#3366cc"
    assert np.abs(Scene(scene.items[:2]).bounds - [(0, 0, 10), (40, 30, 23)]).max() < 1e-6
    assert scene.sheet is not None and scene.sheet.made_of == (("plate", "S235JR"),)
    assert scene.sheet.fields == (("A", "B"),) and scene.items[1].exact is None
    assert vp.read(tmp_path / "whole.scene", parts="exact").items[1].exact is not None
    out = str(tmp_path / "whole.svg")
    assert run(["sheet", str(tmp_path / "whole.scene"), "-o", out, "--parts-list", "--parts", "exact"]) == 0
    (tmp_path / "other.scene").write_text("B gray box 1 1 1", encoding="utf-8")
    assert run(["draw", str(tmp_path / "other.scene"), "-o", out, "--parts", "exact"]) == 1
    assert "other.scene: a way of drawing parts is for CAD parts only" in capsys.readouterr().err


def test_iges_files_that_end_amid_their_data_are_told(opencascade: None, tmp_path: Path):
    writer = occ("IGESControl", "IGESControl_Writer")("MM", 0)
    writer.AddShape(cad_parts.box(40, 30, 20))
    writer.Write(str(tmp_path / "box.igs"))
    whole = (tmp_path / "box.igs").read_bytes()
    assert vp.read(tmp_path / "box.igs").items[0].mesh.is_closed
    (tmp_path / "part.igs").write_bytes(whole[: int(0.9 * len(whole))])
    with pytest.warns(vp.InputWarning, match=r"part\.igs: it ends amid its data: faces may be missing"):
        vp.read(tmp_path / "part.igs")
