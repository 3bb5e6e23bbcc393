"""Surfaces trimmed by closed curves in u and v: what is left of them, in their domains and in files."""

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot import curves, surfaces
from vectorplot.curves import bezier
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.surfaces import Domain, TrimmedSurface
from vectorplot.surfaces.parameter_regions import ParameterRegions
from vectorplot.surfaces.trimmed import trims_of, uncut

BALL, TUBE, RING = surfaces.Sphere(), surfaces.Cylinder(1.0, -1.0, 2.0), surfaces.Torus()
SHEET = surfaces.graph(lambda x, y: 0.2 * x * y, Domain(-2.0, 2.0, -2.0, 2.0))


def star(u: float, v: float, size: float = 1.0) -> list[tuple[float, float]]:
    angle, radius = np.arange(10) * np.pi / 5, size * np.tile([0.6, 0.25], 5)
    return list(zip(u + radius * np.cos(angle), v + radius * np.sin(angle), strict=True))


def wave(height: float, way: float = 1.0) -> curves.Curve:
    return curves.curve_of_function(lambda t: (way * t, height + 0.3 * np.sin(3 * way * t), 0 * t), 0.0, 2.0 * np.pi)


def places(surface: TrimmedSurface, count: int = 20_000) -> tuple[np.ndarray, np.ndarray]:
    d, rng = surface.domain, np.random.default_rng(count)
    return rng.uniform(d.u_start, d.u_end, count), rng.uniform(d.v_start, d.v_end, count)


def left(surface: TrimmedSurface, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return np.isfinite(surface.points(u, v)).all(axis=-1)


def test_polygons_are_exact_whatever_their_shape():
    trimmed = TrimmedSurface(SHEET, trims=[star(0, 0, 3)], holes=[star(0, 0, 1), star(1.2, 0.0, 0.3)])
    polygon = shapely.Polygon(star(0, 0, 3)).difference(shapely.Polygon(star(0, 0, 1)))
    polygon = polygon.difference(shapely.Polygon(star(1.2, 0.0, 0.3)))
    u, v = places(trimmed)
    assert np.array_equal(left(trimmed, u, v), shapely.contains_xy(polygon, u, v))
    # Corners and middles of sides belong to the surface.
    corners = np.array([*star(0, 0, 3), *star(0, 0, 1)])
    assert left(trimmed, *corners.T).all()
    assert left(trimmed, *(0.5 * (corners + np.roll(corners, -1, axis=0)))[:9].T).all()


@pytest.mark.parametrize("away", [-2.0 * np.pi, 0.0, 4.0 * np.pi])
def test_a_round_hole_over_a_seam_is_a_disc_in_every_round(away):
    trimmed = TrimmedSurface(BALL, holes=[curves.Circle((0.1 + away, 0.2, 0.0), 0.4)])
    u, v = places(trimmed)
    off = np.hypot((u - 0.1 + np.pi) % (2.0 * np.pi) - np.pi, v - 0.2)
    assert trimmed.domain.closed_u and (np.abs(off - 0.4) < 0.1).sum() > 500
    assert np.array_equal(left(trimmed, u, v), off >= 0.4)
    angle = np.linspace(0.0, 2.0 * np.pi, 1000)
    around = 0.1 + 0.4 * np.cos(angle), 0.2 + 0.4 * np.sin(angle)
    assert left(trimmed, *around).all()


def test_curves_that_run_round_leave_what_is_to_their_left():
    above, below = TrimmedSurface(TUBE, trims=[wave(0.5)]), TrimmedSurface(TUBE, trims=[wave(0.5, -1.0)])
    u, v = places(above)
    assert above.domain.closed_u and above.domain.v_end == 2.0 and below.domain.v_start == -1.0
    assert np.array_equal(left(above, u, v), v >= 0.5 + 0.3 * np.sin(3 * u))
    both = TrimmedSurface(TUBE, trims=[wave(-0.4)], holes=[wave(1.2)])
    u, v = places(both)
    assert np.array_equal(left(both, u, v), np.abs(v - 0.3 * np.sin(3 * u) - 0.4) <= 0.8)
    seam = np.array([0.0, 1e-15, 2.0 * np.pi - 1e-15, 2.0 * np.pi])
    assert left(both, seam, np.full(4, 0.4)).all() and not left(both, seam, np.full(4, 1.9)).any()


def test_an_island_within_a_hole_is_left():
    rings = [curves.Circle((1.5, 0.0, 0.0), radius) for radius in (1.0, 0.6, 0.3)]
    trimmed = TrimmedSurface(BALL, trims=[rings[0], rings[2]], holes=[rings[1]])
    u, v = places(trimmed)
    off = np.hypot(u - 1.5, v)
    assert np.array_equal(left(trimmed, u, v), ((off <= 1.0) & (off >= 0.6)) | (off <= 0.3))


def test_curves_may_be_rounds_away_from_what_they_trim():
    window = curves.Circle((0.2, 0.0, 0.0), 0.8)
    far = [curves.Circle((0.1 + 2.0 * np.pi * k, 0.2 * k, 0.0), 0.1) for k in (-2, 0, 2)]
    trimmed = TrimmedSurface(BALL, trims=[window], holes=far)
    u, v = places(trimmed)
    gone = np.any([np.hypot(u - 0.1, v - 0.2 * k) < 0.1 for k in (-2, 0, 2)], axis=0)
    assert not trimmed.domain.closed_u and gone.sum() > 500
    assert np.array_equal(left(trimmed, u, v), (np.hypot(u - 0.2, v) <= 0.8) & ~gone)
    part = TrimmedSurface(BALL, u=(-1.0, 1.0), holes=[curves.Circle((2.0 * np.pi - 0.5, 0.0, 0.0), 0.2)])
    assert left(part, np.array([-0.5, 0.5]), np.zeros(2)).tolist() == [False, True]


def test_borders_run_along_the_curves_with_the_surface_beside_them():
    trimmed = TrimmedSurface(RING, holes=[curves.Circle((6.2, 0.1, 0.0), 0.3), star(3.0, 3.0)])
    region = trims_of(trimmed)
    assert isinstance(region, ParameterRegions)
    control = region.borders.control
    at = bezier.bezier_points(control, np.full(len(control), 0.37))
    way, along = region.inwards(at, np.zeros(len(at), dtype=np.intp))
    assert (np.abs((way * along).sum(axis=1)) < 1e-9).all()
    for step, there in ((1e-4, True), (-1e-4, False)):
        assert (left(trimmed, *(at + step * way).T) == there).all()
    assert region.borders.closed.all() and len(region.borders.closed) == 2
    inside = at + 0.01 * way
    assert not np.any(region.inwards(inside, np.zeros(len(at), dtype=np.intp))[0])


def test_curves_beyond_the_domain_and_along_its_ends_are_no_borders():
    whole = TrimmedSurface(SHEET, trims=[[(-9, -9), (9, -9), (9, 9), (-9, 9)]])
    assert left(whole, *places(whole)).all() and not len(whole.region.borders.closed)
    half = TrimmedSurface(SHEET, trims=[[(-2, -2), (0, -2), (0, 2), (-2, 2)]])
    assert half.region.borders.offsets.tolist() == [0, 1]
    cut_off = TrimmedSurface(SHEET, holes=[curves.Circle((2.0, 0.0, 0.0), 1.0)])
    assert cut_off.region.borders.closed.tolist() == [False]
    ends = cut_off.region.borders.control[[0, -1], [0, 3]]
    assert np.allclose(np.abs(ends), [(2.0, 1.0)] * 2, atol=1e-9)


def test_the_whole_surface_has_the_same_domain_and_no_trims():
    trimmed = TrimmedSurface(BALL, trims=[star(1.0, 0.2)]).transformed(np.diag([1.0, 2.0, 1.0, 1.0]))
    whole = uncut(trimmed)
    assert whole.domain == trimmed.domain and trims_of(whole) is None and trims_of(trimmed) is not None
    assert np.isfinite(whole.points(*places(trimmed))).all()


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_size_of_parameters_does_not_matter(scale):
    sheet = surfaces.graph(lambda x, y: 0 * x, Domain(-2.0 * scale, 2.0 * scale, -2.0 * scale, 2.0 * scale))
    corners = np.array(star(0.0, 0.0, 2.0))
    trimmed = TrimmedSurface(sheet, trims=[corners * scale])
    u, v = places(trimmed, 2000)
    assert np.array_equal(left(trimmed, u, v), shapely.contains_xy(shapely.Polygon(corners), u / scale, v / scale))


@pytest.mark.parametrize(
    ("loops", "message"),
    [
        ([[(0, 0), (1, 1), (1, 0), (0, 1)]], "must not cross or touch"),
        ([star(0, 0), star(0.3, 0)], "must not cross or touch"),
        ([[(0, 0), (1, 1)]], "trim 1: a polygon has at least three corners"),
        ([star(0, 0), [(0, 0), (np.nan, 1), (1, 0)]], "trim 2: expected corners"),
        (["abc"], "trim 1: expected corners"),
        ([curves.Line((0, 0, 0), (1, 1, 0))], "trim 1: a curve that does not close: it begins at 0 0 and ends at 1 1"),
        ([curves.Circle((0, 0, 1), 1.0)], "leaves the plane z = 0"),
        ([curves.curve_of_function(lambda t: (1 / t, t, t), -1.0, 1.0)], "not finite"),
        ([star(9, 9)], "leave nothing"),
    ],
)
def test_what_trims_nothing_is_refused(loops, message):
    with pytest.raises(vp.InputError, match=message):
        TrimmedSurface(SHEET, trims=loops)


def test_curves_that_cross_over_a_seam_are_refused():
    holes = [curves.Circle((u, 0.0, 0.0), 0.2) for u in (0.1, 2.0 * np.pi - 0.1)]
    with pytest.raises(vp.InputError, match="must not cross or touch"):
        TrimmedSurface(BALL, holes=holes)
    assert TrimmedSurface(SHEET, holes=[curves.Circle((u, 0.0, 0.0), 0.2) for u in (-0.3, 0.3)]).region is not None


def test_a_curve_that_runs_round_a_torus_bounds_nothing():
    with pytest.raises(vp.InputError, match="closes only that way"):
        TrimmedSurface(RING, trims=[wave(1.0)])


TEXT = (
    'BALL surface sphere 1 trim_hole "0.4*cos(t)" "0.2+0.4*sin(t)" t 0 "2*pi" trim_hole 1 0, 1.5 0, 1.2 0.5 '
    'CUP surface cylinder 1 -1 2 translation 2.6 0 0 trim "t" "1+0.3*sin(3*t)" t 0 "2*pi"'
)


def test_files_say_it_and_are_written_again():
    scene = parse_scene(TEXT)
    again = parse_scene(write_scene(scene))
    for one, two in zip(scene.items, again.items, strict=True):
        u, v = places(one.shape, 500)
        assert np.array_equal(one.shape.points(u, v), two.shape.points(u, v), equal_nan=True)
    assert not left(scene.items[0].shape, np.array([0.0, 1.2]), np.array([0.2, 0.1])).any()
    python = vp.Scene([vp.Item("A", TrimmedSurface(BALL, holes=[curves.Circle()]))])
    with pytest.raises(vp.InputError, match="no word for a Circle that trims"):
        write_scene(python)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("A box 1 1 1 trim 0 0, 1 0, 1 1", "'trim' is for surfaces only"),
        ("A curve helix 1 1 trim_hole 0 0, 1 0, 1 1", "'trim_hole' is for surfaces only"),
        ("A surface implicit_torus 3 1 trim 0 0, 1 0, 1 1", "with parameters u and v only"),
        ("A surface torus 3 1 trim 0 0 1 0", "expected 't' and its range, or ','"),
        ('A surface torus 3 1 trim "t" t 0 1', "formula"),
        ('A surface torus 3 1 trim "t" "x" t 0 1', "x"),
        ('A surface torus 3 1 trim "t" "t" t 1 1', "trim: "),
        ("A surface torus 3 1 trim 0 0, 1 0", "at least three corners"),
    ],
)
def test_mistakes_in_files_are_told(text, cause):
    with pytest.raises(vp.InputError, match=cause) as told:
        parse_scene(text)
    assert ":1: A: " in str(told.value)
