"""Polygons that reach under those painted after them, and nowhere else."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.fill_samples import fan, flat, page_of, pictures, shaded

from vectorplot.backends import shaded_triangles
from vectorplot.backends.cairo import pdf_bytes, ps_bytes
from vectorplot.backends.page import areas
from vectorplot.backends.shaded_triangles import HOLLOW_MICRONS, grown, underlaps
from vectorplot.drawing.fills import Fills
from vectorplot.errors import InputWarning

DARK = (16, 20, 24)


def shapes(microns, offsets) -> list[shapely.Polygon]:
    return [shapely.Polygon(microns[a:b]) for a, b in pairwise(offsets)]


@pytest.mark.parametrize("seed", range(4))
def test_polygons_grow_only_under_later_ones(seed):
    random = np.random.default_rng(seed)
    triangles = np.array(fan((30, 20), 15, 40))[random.permutation(40)]
    found = areas(flat(list(triangles), [DARK] * 40), 60.0, 40.0)
    laps = underlaps(found)
    microns, offsets, parts = grown(found, laps)
    before, after = shapes(found.microns, found.offsets), shapes(microns, offsets)
    rounding = 3.0
    for number in range(40):
        later = shapely.union_all(before[number:]).buffer(rounding)
        own = shapely.union_all(after[parts[number] : parts[number + 1]])
        assert later.contains(own)
        assert own.buffer(rounding).contains(before[number])
    assert len(laps.side) > 20 and len(laps.owner) == 1, "the middle of the fan is inside"


@pytest.mark.parametrize("bend", [0.0, 0.01, 0.1])
def test_nothing_goes_along_the_border_to_a_third_polygon(bend):
    """A side that ends amid a nearly straight border of the polygon that is painted after it."""
    left = [(5.0, 5.0), (20.0, 5.0), (20.0 + bend, 20.0), (20.0, 35.0), (5.0, 35.0)]
    low, high = [(20.0, 5.0), (40.0, 5.0), (20.0 + bend, 20.0)], [(20.0 + bend, 20.0), (40.0, 35.0), (20.0, 35.0)]
    found = areas(
        flat([np.array(one) for one in (low, high, left)], [(180, 180, 180), (220, 220, 220), DARK]), 60.0, 40.0
    )
    microns, offsets, parts = grown(found, underlaps(found))
    every = shapes(microns, offsets)
    other = shapely.union_all(every[parts[1] : parts[2]])
    border = shapely.LineString([(20_000, 5_000), (20_000 + 1_000 * bend, 20_000)]).buffer(20.0)
    assert other.intersection(border).bounds[1] > 18_000 - 10
    # It still goes under the other one, all along their common side.
    side = shapely.LineString([(20_000 + 1_000 * bend - 200, 20_500), (20_000 - 200, 34_500)])
    assert other.buffer(5.0).contains(side)


def test_under_transparent_polygons_nothing_goes_and_under_concave_ones_little():
    left, right = [(0, 0), (10, 0), (10, 10), (0, 10)], [(10, 0), (20, 0), (20, 10), (10, 10)]
    arrow = [(10, 0), (20, 0), (12, 5), (20, 10), (10, 10)]
    clear, hollow, back = (
        areas(flat([left, other], [DARK, DARK], opacity=[1.0, opacity]), 60.0, 40.0)
        for other, opacity in ((right, 0.5), (arrow, 1.0), (right, 1.0))
    )
    assert not len(underlaps(clear).side) and not len(underlaps(clear).owner)
    laps = underlaps(hollow)
    assert not len(laps.side) and laps.owner.tolist() == [0]
    assert np.ptp(laps.added[0], axis=0).tolist() == [HOLLOW_MICRONS, 10_000]
    assert underlaps(back).side.tolist() == [1] and not len(underlaps(back).owner)


@pytest.mark.parametrize("hidden", [False, True])
def test_lines_around_polygons_stay_off_other_colours(hidden):
    angle = np.linspace(0.0, np.pi, 49)
    rim = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    middle = np.array((20.0, 10.0))
    thin = [np.stack((middle, middle + 10.0 * a, middle + 10.0 * b)) for a, b in pairwise(rim)]
    around = [middle + np.stack((10.0 * a, 20.0 * a, 20.0 * b, 10.0 * b)) for a, b in pairwise(rim)]
    below = np.array([(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (0.0, 10.0)])
    first = [below + np.array((0.0, 1.0))] if hidden else []
    polygons = [*first, below, *around, *thin]
    colours = [DARK] * len(first) + [(200, 200, 200)] + [DARK] * 96
    found = areas(flat(polygons, colours), 60.0, 40.0)
    laps = underlaps(found)
    foreign = shapely.Polygon(1000.0 * below)
    for number in np.flatnonzero(laps.open):
        line = shapely.Polygon(found.microns[found.offsets[number] : found.offsets[number + 1]]).buffer(70.0)
        assert number < len(first) or not line.intersects(foreign)


@pytest.mark.parametrize("seed", range(3))
def test_fine_meshes_are_judged_by_their_neighbourhood_as_side_by_side(seed, monkeypatch):
    """Triangles of half a millimetre about a hole, an unlike patch and other ones painted over them."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(5, 55, 100), np.linspace(5, 35, 60))
    x[1:-1, 1:-1] += random.uniform(-0.1, 0.1, (58, 98))
    corner = np.stack((x, y), axis=2)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    triangles = np.concatenate([np.stack((a, b, c), axis=2), np.stack((a, c, d), axis=2)]).reshape(-1, 3, 2)
    middle = triangles.mean(axis=1)
    triangles = triangles[np.hypot(*(middle - (20, 20)).T) > 4.0]
    middle = triangles.mean(axis=1)
    shade = np.rint(140 + 60 * np.sin(middle[:, 0] / 9)).astype(int)
    shade[np.hypot(*(middle - (40, 22)).T) < 3.0] = 20
    over = list(triangles[(middle[:, 0] < 12) & (middle[:, 1] < 12)] + (30.1, 2.3))
    found = areas(flat([*triangles, *over], [(int(v),) * 3 for v in shade] + [(250, 250, 250)] * len(over)), 60.0, 40.0)
    asked = []
    true = shaded_triangles._amid
    monkeypatch.setattr(
        shaded_triangles, "_amid", lambda sides, which: (asked.append(which.sum()), true(sides, which))[1]
    )
    quick = underlaps(found)
    monkeypatch.setattr(shaded_triangles, "_plainly_amid", lambda sides, which, ends: np.zeros_like(which))
    slow = underlaps(found)
    assert asked[0] < 0.3 * asked[1], "most are told by their neighbourhood"
    for name in ("side", "near", "far", "open", "owner", "along", "added"):
        assert np.array_equal(getattr(quick, name), getattr(slow, name)), name


def test_neighbours_in_heaps_are_not_looked_for():
    random = np.random.default_rng(3)
    start = random.random((8000, 2)) * (60.0, 40.0)
    needles = list(np.stack([start, start + random.normal(0.0, 9.0, (8000, 2)), start + np.array((0.2, 0.1))], axis=1))
    with pytest.warns(InputWarning, match=r"^so many polygons lie on one another"):
        laps = underlaps(areas(flat(needles, [DARK] * 8000), 60.0, 40.0))
    assert not len(laps.side) and not len(laps.owner)


def random_scene(seed: int) -> Fills:
    """Polygons that overlap, and such that share sides whole, in part, or nearly, in many colours: a plane cut into
    rectangles of all sizes, over and under other things."""
    random = np.random.default_rng(seed)
    turn = np.linalg.qr(random.normal(size=(2, 2)))[0]
    rows = []
    for y in range(6):
        ends = np.sort(np.concatenate(([0.0, 30.0], random.uniform(0.0, 30.0, 5))))
        rows += [[(a, 3 * y), (b, 3 * y), (b, 3 * y + 3), (a, 3 * y + 3)] for a, b in pairwise(ends)]
    plane = (np.array(rows) - (15, 9)) @ turn + (30, 20)
    loose = random.uniform(5, 55, (12, 1, 2)) * (1, 2 / 3) + random.normal(scale=6.0, size=(12, 3, 2))
    order = random.permutation(len(plane) + len(loose))
    every = [*plane, *loose]
    return flat([every[k] for k in order], random.integers(0, 256, (len(every), 3)))


def exactly_painted(fills: Fills, size: tuple[int, int], per_mm: float, finer: int = 8) -> np.ndarray:
    """The picture of polygons on white paper, of the means of many places in each pixel."""
    columns, rows = size
    x, y = ((np.arange(finer * n) + 0.5) / (finer * per_mm) for n in (columns, rows))
    places = shapely.points(*(c.ravel() for c in np.meshgrid(x, y[::-1])))
    tree = shapely.STRtree(places)
    colours = np.full((len(places), 3), 255.0)
    for a, b in pairwise(fills.offsets):
        colours[tree.query(shapely.Polygon(fills.points[a:b]), predicate="contains")] = fills.colours[a]
    return colours.reshape(rows, finer, columns, finer, 3).mean(axis=(1, 3))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_pictures_are_what_exact_painting_gives(seed, tmp_path):
    """Neither seams between neighbours nor borders that are too wide, whatever is painted over what."""
    fills = random_scene(seed)
    expected = exactly_painted(fills, (300, 200), 5.0)
    for name, picture in pictures(page_of(fills), tmp_path, dpi=127).items():
        off = np.abs(picture[:200, :300] - expected).max(axis=2)
        # Corners at which many sides meet, and what readers do with the part of a pixel.
        limit = 0.004 if name in ("png", "svg") else 0.012
        assert (off > 40).mean() < limit and (off > 100).mean() < limit / 4, (name, (off > 40).mean(), off.max())


def test_a_mesh_is_one_shading_of_triangles():
    triangles = fan((30, 20), 15, 200)
    colours = [[(k, k, k), (k + 40, k + 40, k + 40), (k, k, k)] for k in range(200)]
    drawing = page_of(shaded(list(triangles), colours))
    pdf, ps = pdf_bytes(drawing), ps_bytes(drawing)
    for data in (pdf, ps):
        assert data.count(b"/ShadingType 4") == 1 and b"/ShadingType 7" not in data
    assert len(pdf) < 20_000 and len(ps) < 40_000
    # The table of contents names where objects begin.
    table = int(pdf[pdf.rindex(b"startxref") + 9 :].split()[0])
    assert pdf[table : table + 4] == b"xref"
    entries = pdf[table:].split(b"\n")[3:]
    for number, entry in enumerate(entries, start=1):
        if not entry.endswith(b"n "):
            break
        assert pdf[int(entry[:10]) :].startswith(b"%d 0 obj" % number)


@pytest.mark.slow
@pytest.mark.parametrize("fold", ["spur", "bridge"])
def test_folds_without_area_leave_no_line(fold, tmp_path):
    """Clipping leaves such folds in shadows that are not convex: out and back again, or on to another part."""
    ground = [(2, 2), (58, 2), (58, 38), (2, 38)]
    spur = [(10, 10), (20, 10), (20, 20), (45, 20), (20, 20), (10, 20)]
    bridge = [(10, 20), (10, 10), (20, 10), (20, 20), (40, 20), (40, 10), (50, 10), (50, 20)]
    fills = flat([ground, {"spur": spur, "bridge": bridge}[fold]], [(240, 240, 240), DARK])
    rows, columns = (slice(*(int(end / 25.4 * 200) for end in ends)) for ends in ((19, 21), (22, 38)))
    for name, picture in pictures(page_of(fills), tmp_path, dpi=200).items():
        # Ghostscript shows some of what has no width.
        assert picture[rows, columns].min() > (150 if name in ("ps", "eps") else 200), name
