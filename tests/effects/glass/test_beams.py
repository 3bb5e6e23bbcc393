"""Beams of sight rays through convex bodies: those that rays need, and not many more."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.effects.glass import Solid, soup_in_beams
from vectorplot.effects.refraction import Soup, traced
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import hull_mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look


def ball_and_cage(seed: int) -> tuple[View, Solid, np.ndarray]:
    """A ball of glass in a box that is seen wherever a ray goes, and the faces it turns to the eye."""
    random = np.random.default_rng(seed)
    points = random.normal(size=(40, 3))
    ball = hull_mesh(points / np.linalg.norm(points, axis=1)[:, None])
    cage = hull_mesh(9.0 * np.array(list(np.ndindex(2, 2, 2))) - 4.5)
    view = look(Scene((Item("G", ball), Item("C", cage))), Camera(eye=(2.0, -3.0, 2.0), parallel=seed % 2 == 1))
    solid = Solid.of(view, 0, 1.5)
    eye = view.eye[:, None] if view.eye is not None else None
    start = solid.points[:, solid.offsets[:-1]]
    towards = eye - start if eye is not None else np.array([[0.0], [0.0], [1.0]])
    return view, solid, np.flatnonzero((towards * solid.planes[:3]).sum(axis=0) > 1e-9)


@pytest.mark.slow
@pytest.mark.capability("G6.6-solid")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", range(4))
def test_every_ray_that_leaves_is_in_a_beam_and_meets_what_the_beam_meets(seed: int) -> None:
    view, solid, front = ball_and_cage(seed)
    others = np.flatnonzero(view.face_item == 1)
    position = np.concatenate([np.arange(view.offsets[k], view.offsets[k + 1]) for k in others])
    offsets = np.append(0, np.cumsum(view.face_sizes[others]))
    rest = Soup(view.points[:, view.corners[position]], offsets, others, np.zeros_like(others))
    everywhere = np.tile([[-9.0], [9.0], [-9.0], [9.0]], len(front))
    found = soup_in_beams(view, solid, front, everywhere, rest)
    pairs = {(f, b) for beams, _ in found for f, b in zip(beams.front.tolist(), beams.back.tolist(), strict=True)}
    used = set()
    random = np.random.default_rng(seed)
    for number, face in enumerate(front.tolist()):
        corners = solid.points[:, solid.offsets[face] : solid.offsets[face + 1]]
        image = view.image_of(corners @ random.dirichlet(np.ones(corners.shape[1]), 60).T)
        inside = traced(view, solid.sight_ways(np.array([face])), image)
        slope = solid.planes[:3].T @ inside.direction
        off = solid.planes[3][:, None] - solid.planes[:3].T @ inside.place
        back = np.where(slope > 1e-9, off / np.where(slope > 1e-9, slope, 1.0), np.inf).argmin(axis=0)
        for leaf in np.unique(back).tolist():
            out = traced(view, solid.sight_ways(np.array([face]), np.array([leaf])), image[:, back == leaf])
            if out.passes.any():
                used.add((number, leaf))
    assert used <= pairs
    assert len(pairs) < 0.5 * len(front) * (len(solid.face) - 1)
