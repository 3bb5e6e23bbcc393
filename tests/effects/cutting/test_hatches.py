"""How cut faces are hatched where nothing is asked for: by lengths on the page, whatever the size of part and page."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.geometry import box
from vectorplot.scene import Cut


def hatches(drawing: vp.Drawing) -> np.ndarray:
    """(n,2,2) the ends of the strokes that hatch."""
    found = [one for layer in drawing.layers if layer.name == "hatch" for one in layer.strokes]
    return np.concatenate(
        [np.stack([one.points[one.offsets[:-1]], one.points[one.offsets[1:] - 1]], 1) for one in found]
    )


def spacings(ends: np.ndarray) -> np.ndarray:
    """Distances of neighbours of parallel strokes."""
    way = ends[0, 1] - ends[0, 0]
    across = np.array([-way[1], way[0]]) / np.linalg.norm(way)
    return np.diff(np.sort(ends.mean(axis=1) @ across))


@pytest.mark.parametrize("page", [vp.Page(100, 80), vp.Page(1189, 841)])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e5])
def test_strokes_are_so_many_mm_apart_whatever_the_size(size, page):
    block = vp.Scene((vp.Item("B", box((4 * size, 4 * size, 2 * size))),))
    drawing = vp.draw(vp.cut(block, f"y = {2 * size}"), "front", page=page)
    assert spacings(hatches(drawing)) == pytest.approx(2.4, rel=1e-3)


@pytest.mark.parametrize(("scale", "spacing"), [("1:2", 1.2), ("2:1", 2.4), ("5:1", 2.4)])
def test_sections_of_small_parts_on_sheets_are_no_black_blocks(scale, spacing):
    sheet = vp.technical_sheet(vp.Item("P", box((12, 8, 6))), section="x=6", page="A4", scale=scale)
    assert spacings(hatches(sheet)) == pytest.approx(spacing, rel=1e-6)


def test_what_is_left_fills_the_page_and_not_what_is_cut_away():
    rod = vp.Scene((vp.Item("R", box((100, 4, 4))),))
    drawing = vp.draw(vp.cut(rod, "x > 4"), "right", page=vp.Page(100, 80))
    assert spacings(hatches(drawing)) == pytest.approx(2.4, rel=1e-3)


def test_strokes_on_faces_that_are_seen_flat_are_not_too_close():
    block = vp.cut(vp.Scene((vp.Item("B", box((4, 4, 4))),)), "y < 1")
    nearly_edge_on = vp.Camera((40.0, -8.0, 2.0), (2.0, 2.0, 2.0), parallel=True)
    assert spacings(hatches(vp.draw(block, nearly_edge_on))).min() > 0.69


def test_parts_that_touch_have_other_strokes_though_one_is_narrow():
    parts = [box((10, 4, 8)).moved(0, 0, 0), box((10, 4, 0.4)).moved(0, 0, 8), box((10, 4, 8)).moved(0, 0, 8.4)]
    scene = vp.Scene(tuple(vp.Item(f"P{k}", part) for k, part in enumerate(parts)))
    cut = vp.cut(scene, "y = 2")
    drawing = vp.draw(cut, "front", page=vp.Page(100, 80))
    ends, owner = (
        hatches(drawing),
        np.concatenate([one.item for layer in drawing.layers if layer.name == "hatch" for one in layer.strokes]),
    )
    kinds = []
    for k in np.unique(owner):
        own = ends[owner == k]
        way = own[0, 1] - own[0, 0]
        kinds.append((round(float(np.arctan(way[1] / way[0])), 3), round(float(np.median(spacings(own))), 3)))
    assert len(set(kinds[:2])) == 2 and len(set(kinds[1:])) == 2
    assert all(spacing > 0.7 for _, spacing in kinds)


@pytest.mark.slow
def test_sheets_take_the_spacing_that_is_asked_for(tmp_path):
    (tmp_path / "p.scene").write_text("P gray box 12 8 6\n")
    out = tmp_path / "p.json"
    told = ["sheet", str(tmp_path / "p.scene"), "-o", str(out), "--section", "x=6", "--scale", "2:1"]
    assert run([*told, "--cut-spacing", "1.5"]) == 0
    sheet = vp.technical_sheet(vp.Item("P", box((12, 8, 6))), section="x=6", scale="2:1", cut_spacing_mm=1.5)
    assert spacings(hatches(sheet)) == pytest.approx(1.5, abs=1e-6)
    assert len(out.read_text()) > 1000


def test_planes_of_cuts_that_another_cut_leaves_no_face_are_hatched_nowhere():
    cuts = tuple(Cut.of(cut) for cut in ("x > 2, y < 1", "2x - y + 2z > 3"))
    drawing = vp.draw(vp.Scene((vp.Item("A", box((4, 4, 2))),), cuts=cuts), vp.Camera((7, -11, 8)), page="A6")
    assert len(hatches(drawing)) > 4
