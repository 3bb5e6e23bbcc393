"""Lines of smooth surfaces to hatch along: parameter lines so dense that they do for the darkest places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching.followed_lines import FollowedLines
from vectorplot.geometry.vectors import cross, normalize
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Item, Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.capped_quadrics import capped_quadric_of
from vectorplot.surfaces.surface import Surface, is_parametrised

ROUGH = 96
"""Samples along each parameter, to find how far parameter lines are apart on the page."""

FEWEST, MOST = 16, 2048
"""Parameter lines of one family: the most are 0.1 mm apart on a sheet of A4."""

MOST_SAMPLES = 1 << 20
"""Of one surface, where the distance of neighbouring lines is known."""

NEARLY_ALL = 0.98
"""Of the surface; parameter lines may be wider apart on the rest of it, near poles of the parametrisation."""


def followed(item: Item, hatching: Hatching | Stippling | None) -> bool:
    """Whether an item is hatched along parameter lines of its own."""
    on = isinstance(hatching, Hatching) and hatching.by != "none" and hatching.along == "surface"
    return on and is_parametrised(item.shape)


def followed_lines(
    scene: Scene, how: Sequence[Hatching | Stippling | None], placement: Placement, trace: Callable[[Scene], Paths]
) -> list[FollowedLines]:
    """The visible parameter lines to hatch along of each surface, and of each family where they cross.

    how: of every item; trace: the visible lines of a scene in their places, as of draw.
    """
    found: list[FollowedLines] = []
    for family in (0, 1):
        spaced: dict[int, tuple[int, Floats, Floats]] = {}
        items = []
        for number, (item, one) in enumerate(zip(scene.items, how, strict=True)):
            lines: tuple[str, ...] = ()
            if isinstance(one, Hatching) and followed(item, one) and (family == 0 or one.cross):
                assert is_parametrised(item.shape)
                count = _count(item.shape, family, one.spacing_mm, placement)
                spaced[number] = (count, *_samples(item.shape, family, count, placement))
                item = replace(item, curves=SurfaceLines(columns=count) if family == 0 else SurfaceLines(rows=count))
                lines = ("parameter",)
            items.append(replace(item, lines=lines, patterns=()))
        if spaced:
            paths = trace(replace(scene, items=tuple(items)))
            found += [
                FollowedLines(family, number, paths, points, apart, count, _ends(scene.items[number].shape))
                for number, (count, points, apart) in spaced.items()
            ]
    return found


def _ends(shape: object) -> Floats:
    """(3,) the unit normal of the flat ends of a capped body, zero of what is none."""
    body = capped_quadric_of(shape)
    return np.zeros(3) if body is None else normalize(cross(body.frame[0], body.frame[1]))


def _count(surface: Surface, family: int, spacing_mm: float, placement: Placement) -> int:
    """How many parts lines of a family have to divide a surface into, to be no farther apart than a spacing."""
    _, apart = _samples(surface, family, ROUGH, placement)
    known = apart[np.isfinite(apart)]
    widest = float(np.quantile(known, NEARLY_ALL)) if len(known) else 0.0
    return int(np.clip(np.ceil(ROUGH * widest / spacing_mm), FEWEST, MOST))


def _samples(surface: Surface, family: int, count: int, placement: Placement) -> tuple[Floats, Floats]:
    """(s,3) points on lines of a family that divide a surface into so many parts, and (s,) how far on the page their
    neighbours are; (s,) is line after line, count + 1 of them."""
    across = min(max(count, ROUGH), MOST_SAMPLES // count)
    sizes = (count, across) if family == 0 else (across, count)
    u, v = np.meshgrid(*surface.domain.grid(*sizes), indexing="ij")
    if family == 1:
        u, v = u.T, v.T
    points = surface.points(u, v)
    ways = surface.partials(u, v)
    step = surface.domain.size[family] / count
    to, along = (_on_page(points, ways[k], placement.page_from_world) for k in (family, 1 - family))
    length = np.linalg.norm(along, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        apart = step * np.abs(cross(to, along)) / length
    return points.reshape(-1, 3), np.nan_to_num(apart, nan=0.0, posinf=0.0).ravel()


def _on_page(points: Floats, ways: Floats, page_from_world: Floats) -> Floats:
    """(...,2) by how many mm points of the page move where points (...,3) move along ways (...,3)."""
    rows = points @ page_from_world[:, :3].T + page_from_world[:, 3]
    step = ways @ page_from_world[:, :3].T
    depth = rows[..., 3:]
    return np.asarray(step[..., :2] / depth - rows[..., :2] * step[..., 3:] / (depth * depth))
