"""Contours of cut surfaces: all of them is there, whatever the angle to the cut; the same in parallel views and from
afar, and of balls as long as in closed form."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.effort import several

import vectorplot as vp
from vectorplot import features, surfaces
from vectorplot.features.contours_and_isophotes import (
    parallel_contour,
    point_light_isophotes,
    section_by_implicit,
)
from vectorplot.features.parameter_curves import domain_borders
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces.trimmed import CutSurface

FAMILIES = {
    "sphere": "sphere radius 2",
    "torus": "torus 3 1",
    "cylinder": "cylinder 1 -2 2",
    "graph": 'graph "sin(x)*cos(y)" x -3 3 y -3 3',
    "function": 'function "(3+cos(v))*cos(u)" "(3+cos(v))*sin(u)" "sin(v)+0.3*u" u 0 "2*pi" v 0 "2*pi" closed_v',
    "ellipsoid": "ellipsoid 3 2 1.5",
    "helicoid": "helicoid width 1.6 bending 50",
}
FAR = 2e6
SHORT, LONG = 0.003, 0.0005
"""Chords are shorter than the curve, and the true length is counted."""

AFAR = 0.005
"""Part of a length by which a view from so far may differ from a parallel one: where a contour lies on a rim, at a flat
angle, one of them is drawn."""

COVERED = 0.004
"""Part of the extent within which the true contour has drawn one: a chord may be a thousandth of it away."""


def lengths(scene, camera):
    """The lengths in space of all lines by kind, hidden ones too."""
    found = defaultdict(float)
    drawing = vp.draw(scene, camera, hidden="solid", page=vp.Page(200, 200, 5))
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for k, (start, end) in enumerate(zip(paths.offsets[:-1], paths.offsets[1:], strict=True)):
            kind = str(paths.kind[k])
            points = paths.points3d[[*range(start, end), *([start] if paths.closed[k] else [])]]
            found[kind] += float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    return found


def sampled_contour(surface, eye, parallel):
    """Points on the contour: where the lines of a grid in the parameters cross it."""
    d = surface.domain
    u, v = np.meshgrid(np.linspace(d.u_start, d.u_end, 101), np.linspace(d.v_start, d.v_end, 97), indexing="ij")

    def f(u, v):
        normal = np.cross(*surface.partials(u, v))
        return (normal * (eye if parallel else surface.points(u, v) - eye)).sum(axis=-1)

    values, found = f(u, v), []
    for low, high in ((np.s_[:-1, :], np.s_[1:, :]), (np.s_[:, :-1], np.s_[:, 1:])):
        crossed = values[low] * values[high] < 0.0
        start, end = (np.stack([u[side][crossed], v[side][crossed]]) for side in (low, high))
        sign = np.sign(values[low][crossed])
        for _ in range(40):
            middle = 0.5 * (start + end)
            before = np.sign(f(*middle)) == sign
            start, end = np.where(before, middle, start), np.where(before, end, middle)
        found.append(surface.points(*start))
    return np.concatenate(found)


def more_families():
    """Surfaces of other families than those of scene files."""
    knots = np.random.default_rng(8).normal(size=(7, 6, 3)) * 0.3
    knots[..., 0] += np.arange(7)[:, None] - 3.0
    knots[..., 1] += np.arange(6) - 2.5
    profile = surfaces.surface_of_function(
        lambda u, v: ((1.5 + np.sin(2 * v)) * np.cos(u), (1.5 + np.sin(2 * v)) * np.sin(u), v),
        surfaces.Domain(0.0, 2.0 * np.pi, -2.0, 2.0, closed_u=True),
    )
    moved = surfaces.PlacedSurface(surfaces.Torus(2.0, 0.7), np.diag([1.0, 1.3, 0.6]), (0.1, 0.0, 0.2))
    return {"spline": surfaces.spline_surface(knots), "revolution": profile, "placed": moved}


@pytest.mark.parametrize("family", [*FAMILIES, "spline", "revolution", "placed"])
def test_all_of_the_contour_of_a_cut_surface_is_there_and_nothing_else(family, tmp_path):
    if family in FAMILIES:
        (tmp_path / "x.scene").write_text(f"BODY blue surface {FAMILIES[family]}\n", encoding="utf-8")
        surface = vp.read(tmp_path / "x.scene").items[0].shape
    else:
        surface = more_families()[family]
    random = np.random.default_rng(5)
    for number in range(several(2, long=40)):
        normals, way = random.normal(size=(random.integers(1, 4), 3)), random.normal(size=3)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        way /= np.linalg.norm(way)
        region = HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(random.uniform(-0.6, 0.6, len(normals))))
        cut = CutSurface(surface, (region,))
        parallel = number % 2 == 0
        eye = way if parallel else 12.0 * way
        found = parallel_contour(cut, eye) if parallel else features.contour(cut, eye)
        whole = sampled_contour(surface, eye, parallel)
        left = whole[~region.is_inside(whole)]
        extent = np.linalg.norm(np.ptp(surface.points(*surface.domain.grid(16, 16)), axis=0))
        part = np.linspace(0.0, 1.0, 65)[:, None]
        drawn = [
            (line[:-1, None] + part * np.diff(line, axis=0)[:, None]).reshape(-1, 3)
            for line in (found[k] for k in range(len(found)))
        ]
        assert not region.is_inside(found.points).any()
        assert len(whole) or not len(found)
        # Samples on the whole contour are further from each other.
        for points, others, away in ((left, [*drawn, np.zeros((0, 3))], COVERED), (found.points, [whole], 0.1)):
            if len(points):
                assert cKDTree(np.concatenate(others)).query(points)[0].max() <= away * extent, (number, away)


def test_sections_and_isophotes_of_cut_surfaces_end_on_the_planes_too():
    """At whatever angle they come to these: circles on a ball, cut ever nearer to the place at which they touch."""
    for gap in (1e-2, 1e-4, 1e-6):
        cut = CutSurface(surfaces.Sphere(), (HalfSpaces(((1.0, 0.0, 0.0),), (1.0 - gap,)),))
        for found in (
            features.plane_sections(cut, (0.0, 0.0, 1.0), 0.0),
            features.isophotes(cut, (0.0, 0.0, 1.0), 0.0),
            point_light_isophotes(cut, (0.0, 0.0, 5.0), 0.2),
            section_by_implicit(cut, surfaces.implicit_sphere(1.0, (0.0, 0.0, 1.0))),
        ):
            y, z = found.points.T[1:]
            height = z.mean()
            radius = np.sqrt(1.0 - height * height)
            if radius < 1.0 - gap:
                assert found.closed.tolist() == [True]
                continue
            assert len(found) == 1
            ends = np.abs(y[[0, -1]])
            assert np.allclose(ends, np.sqrt(radius**2 - (1.0 - gap) ** 2), rtol=1e-6), (gap, ends)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.filterwarnings("ignore:BODY. open where cut")
def test_parallel_views_of_cut_surfaces_show_what_is_seen_from_afar(family, tmp_path):
    (tmp_path / "x.scene").write_text(f"BODY blue surface {FAMILIES[family]}\n", encoding="utf-8")
    scene, random = vp.read(tmp_path / "x.scene"), np.random.default_rng(len(family))
    for _ in range(several(1, long=12)):
        normal, way = random.normal(size=(2, 3))
        way /= np.linalg.norm(way)
        a, b, c = normal / np.linalg.norm(normal)
        cut = vp.cut(scene, f"{a:.3f}*x {b:+.3f}*y {c:+.3f}*z > {random.uniform(-0.6, 0.6):.3f}")
        parallel = lengths(cut, vp.Camera(eye=tuple(20.0 * way), parallel=True, height=12.0))
        angle = float(np.degrees(2.0 * np.arctan(6.0 / FAR)))
        afar = lengths(cut, vp.Camera(eye=tuple(FAR * way), fov_deg=angle))
        assert parallel.keys() == afar.keys()
        for kind, length in parallel.items():
            assert abs(length - afar[kind]) <= AFAR * max(1.0, length), (kind, length, afar[kind])


@pytest.mark.parametrize("parallel", [False, True])
def test_contours_of_notched_balls_are_as_long_as_in_closed_form(parallel):
    """Of a circle what is not in the notch, counted on many points; two rims may meet in a corner of it."""
    random = np.random.default_rng(35)
    angle = (np.arange(200_000) + 0.5) * 2.0 * np.pi / 200_000
    for _ in range(several(20, long=400)):
        normals = random.normal(size=(2, 3))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        offsets = random.uniform(-0.6, 0.6, 2)
        region = HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))
        ball = CutSurface(surfaces.Sphere(1.0), (region,))
        eye = random.normal(size=3)
        eye *= random.uniform(1.5, 6.0) / np.linalg.norm(eye)
        near = 0.0 if parallel else 1.0 / np.linalg.norm(eye)
        found = parallel_contour(ball, eye) if parallel else features.contour(ball, eye)
        assert np.isfinite(found.points).all()
        total = 0.0
        for start, end, closed in zip(found.offsets[:-1], found.offsets[1:], found.closed, strict=True):
            points = found.points[start:end]
            total += np.linalg.norm(
                np.diff(points[[*range(len(points)), 0][: len(points) + closed]], axis=0), axis=1
            ).sum()
        axis = eye / np.linalg.norm(eye)
        first = np.cross(axis, normals[0])
        first /= np.linalg.norm(first)
        radius = np.sqrt(1.0 - near * near)
        circle = near * axis + radius * (
            np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * np.cross(axis, first)
        )
        truth = radius * 2.0 * np.pi * np.mean(~(circle @ normals.T > offsets).all(axis=1))
        assert -SHORT < total - truth < LONG, (normals, offsets, eye, total, truth)


def test_rims_of_notched_cylinders_are_as_long_as_in_closed_form():
    """Planes through or close by a rim: what they leave of it is there once, however small the notch."""
    random = np.random.default_rng(3)
    angle = (np.arange(200_000) + 0.5) * 2.0 * np.pi / 200_000
    rims = [np.stack([np.cos(angle), np.sin(angle), np.full_like(angle, height)], axis=1) for height in (0.0, 1.0)]
    for number in range(several(40, long=1000)):
        normals = random.normal(size=(2, 3))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        place = rims[1][int(random.integers(len(angle)))]
        offsets = normals @ place - random.uniform(0.0005, 0.05, 2) if number % 2 else random.uniform(-1.0, 1.0, 2)
        region = HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))
        found = domain_borders(CutSurface(surfaces.Cylinder(1.0, 0.0, 1.0), (region,)), features.Tracing())
        total = 0.0
        for start, end, closed in zip(found.offsets[:-1], found.offsets[1:], found.closed, strict=True):
            points = found.points[[*range(start, end), *([start] if closed else [])]]
            total += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        truth = sum(2.0 * np.pi * np.mean(~(rim @ normals.T > offsets).all(axis=1)) for rim in rims)
        # Where next to nothing is left of a surface its grid finds nothing.
        assert abs(total - truth) < 0.01 or truth < 0.5, (normals, offsets, total, truth)
