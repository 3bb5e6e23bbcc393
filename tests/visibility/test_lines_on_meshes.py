"""Isophotes and plane sections that polyhedra carry, in drawings."""

from __future__ import annotations

import numpy as np
import pytest
from smooth_scenes import lit, views

from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.features.polygonize import polygonized
from vectorplot.geometry.camera import Camera
from vectorplot.plan import plan_draw
from vectorplot.scene.scene import Item, Light, Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.surfaces.ellipsoid import Sphere
from vectorplot.surfaces.quadric import implicit_sphere
from vectorplot.surfaces.torus import ImplicitTorus
from vectorplot.testing import assert_drawing_is_right, curves_in_space
from vectorplot.testing.shapes import box
from vectorplot.words import LineKind

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
LEVELS = SurfaceLines(sections=(Section((0.0, 0.0, 1.0), (-0.5, 0.25)),))


def lengths(drawing: Drawing, kind: str, hidden: bool) -> float:
    """Of strokes in space."""
    total = 0.0
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero((paths.kind == LineKind.from_word(kind)) & ((paths.hidden_by > 0) == hidden)):
                points = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                points = np.concatenate([points, points[:1]]) if paths.closed[k] else points
                total += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    return total


@pytest.mark.capability("G9.3-sections")
def test_sections_of_a_cube_are_squares_half_of_which_are_seen() -> None:
    drawing = draw(Scene((Item("cube", CUBE, curves=LEVELS),)), Camera((8.0, 7.0, 3.0)), hidden="solid")
    for line in curves_in_space(drawing, kind="section"):
        assert np.isin(np.round(line[:, 2], 12), (-0.5, 0.25)).all()
        assert np.allclose(np.abs(line[:, :2]).max(axis=1), 1.0)
    assert np.isclose(lengths(drawing, "section", False), 8.0)
    assert np.isclose(lengths(drawing, "section", True), 8.0)


@pytest.mark.capability("G9.3-isophote")
def test_isophotes_across_the_faces_of_a_sphere_are_circles() -> None:
    mesh = polygonized(implicit_sphere(1.0), 40)
    lamp = Light((0.0, 0.0, 1.0), parallel=True)
    scene = Scene((Item("ball", mesh, curves=SurfaceLines(isophotes=(0.5,))),), lights=(lamp,))
    drawing = draw(scene, Camera((0.0, -9.0, 0.0), parallel=True), lines=("isophote",), hidden="solid")
    points = np.concatenate(curves_in_space(drawing, kind="isophote"))
    assert np.abs(points[:, 2] - 0.5).max() < 0.02
    seen, unseen = (lengths(drawing, "isophote", hidden) for hidden in (False, True))
    assert np.isclose(seen + unseen, 2.0 * np.pi * np.sqrt(0.75), rtol=0.05)
    assert np.isclose(seen, unseen, rtol=0.02)


@pytest.mark.parametrize("lamp", [Light((1.0, 2.0, 3.0), parallel=True), Light((2.0, 3.0, 5.0))])
def test_lines_on_meshes_as_rays_see_them(lamp: Light) -> None:
    lines = SurfaceLines(isophotes=(-0.3, 0.4), sections=(Section((0.3, 0.1, 1.0), (-0.2, 0.3)),))
    scene = Scene(
        (
            Item("ring", polygonized(ImplicitTorus(2.0, 0.7), 24), curves=lines),
            Item("cube", CUBE, curves=LEVELS),
            Item("ball", Sphere(0.8, (1.0, -1.5, 0.9)), curves=SurfaceLines(4, 3)),
        ),
        lights=(lamp,),
    )
    for seed, camera in enumerate(views(scene, 2, 3)):
        drawing = draw(scene, camera, hidden="solid")
        assert_drawing_is_right(drawing, scene, camera, samples=250, seed=seed, clearance=3e-6)
        assert all(lengths(drawing, kind, hidden) > 0.5 for kind in ("isophote", "section") for hidden in (False, True))


def test_the_stage_runs_only_where_it_is_called_for() -> None:
    def stages(*items: Item, kinds: tuple[LineKind, ...] = tuple(LineKind)) -> set[str]:
        return {stage.name for stage in plan_draw(Scene(items), frozenset(kinds), "none", 0.0)}

    assert "lines on meshes" in stages(Item("cube", CUBE, curves=LEVELS))
    assert "lines on meshes" not in stages(Item("cube", CUBE))
    assert "lines on meshes" not in stages(Item("cube", CUBE, curves=SurfaceLines(3, 3)))
    assert "lines on meshes" not in stages(Item("ball", Sphere(1.0), curves=LEVELS))
    assert "lines on meshes" not in stages(Item("cube", CUBE, curves=LEVELS), kinds=(LineKind.CONTOUR,))


def test_a_light_that_is_not_there_is_an_error() -> None:
    with pytest.raises(InputError, match="cube: isophotes of light 1: the scene has 1 lights"):
        draw(lit(Item("cube", CUBE, curves=SurfaceLines(isophotes=(0.5,), light=1))))
