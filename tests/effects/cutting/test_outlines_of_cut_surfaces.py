"""Contours of cut surfaces: the same in parallel views and from afar, and of balls as long as in closed form."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pytest
from support.effort import several

import vectorplot as vp
from vectorplot import features, surfaces
from vectorplot.features.contours_and_isophotes import parallel_contour
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
FAR = 20000.0
SHORT, LONG = 0.15, 0.003
"""Where a contour comes to a cut at a flat angle it ends a little before it."""

AFAR = 0.01
"""Part of a length by which a view from so far may differ from a parallel one: its lines end a little elsewhere."""


def lengths(scene, camera):
    """The lengths in space of all lines by kind, hidden ones too."""
    found = defaultdict(float)
    drawing = vp.draw(scene, camera, hidden="solid", page=vp.Page(200, 200, 5))
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for k, (start, end) in enumerate(zip(paths.offsets[:-1], paths.offsets[1:], strict=True)):
            kind = str(paths.kind[k])
            found[kind] += float(np.linalg.norm(np.diff(paths.points3d[start:end], axis=0), axis=1).sum())
    return found


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
