"""Lines of items to hatch along, so dense that they do for the darkest places: parameter lines, and lines that flow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.hatching.densities import ranks
from vectorplot.drawing.hatching.followed_lines import FollowedLines
from vectorplot.geometry.vectors import cross, normalize
from vectorplot.painting.flowing_lines import field_of, flowing_lines, flows, on_page
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.lines.curve_light import curve_light
from vectorplot.scene.lines.integral_lines import KnownCurves
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import View
from vectorplot.surfaces.quadric_bodies.capped_quadrics import capped_quadric_of
from vectorplot.surfaces.surface import Surface, is_parametrised

ROUGH = 96
"""Samples along each parameter, to find how far parameter lines are apart on the page."""

FEWEST, MOST = 16, 2048
"""Parameter lines of one family: the most are 0.1 mm apart on a sheet of A4."""

MOST_SAMPLES = 1 << 20
"""Of one surface, where the distance of neighbouring lines is known."""

SHORTEST = 3.0
"""Times their distance that strokes are long which flow, at least: shorter ones are specks."""

NEARLY_ALL = 0.98
"""Of the surface; parameter lines may be wider apart on the rest of it, near poles of the parametrisation."""


def followed(item: Item, hatching: Hatching | Stippling | None) -> bool:
    """Whether an item is hatched along lines of its own."""
    if not isinstance(hatching, Hatching) or hatching.by == "none" or hatching.along == "page":
        return False
    return is_parametrised(item.shape) if hatching.along == "surface" else flows(item, hatching.along)


def followed_lines(
    scene: Scene,
    how: Sequence[Hatching | Stippling | None],
    view: View,
    placement: Placement,
    trace: Callable[[Scene], Paths],
    tolerance_mm: float,
    crease_angle_deg: float,
) -> list[FollowedLines]:
    """The visible lines to hatch along of each item that has such, and of each family where they cross.

    how: of every item; view: of the scene; trace: the visible lines of a scene in their places, as of draw;
    tolerance_mm, crease_angle_deg: as of draw.
    """
    found: list[FollowedLines] = []
    for family in (0, 1):
        spaced: dict[int, SpacedLines] = {}
        items = []
        for number, (item, one) in enumerate(zip(scene.items, how, strict=True)):
            lines: tuple[str, ...] = ()
            if isinstance(one, Hatching) and followed(item, one) and (family == 0 or one.cross):
                light = curve_light(scene, view, item)
                spaced[number] = _spaced(item, one, family, light, placement, tolerance_mm, crease_angle_deg)
                item = replace(item, curves=spaced[number].asked)
                lines = ("parameter", "integral")
            items.append(replace(item, lines=lines, patterns=()))
        if spaced:
            paths = trace(replace(scene, items=tuple(items)))
            found += [
                FollowedLines(
                    family,
                    number,
                    paths,
                    own.samples,
                    own.apart,
                    own.line,
                    own.ranks,
                    _ends(scene, number),
                    own.shortest_mm,
                )
                for number, own in spaced.items()
            ]
    return found


@dataclass(frozen=True, eq=False)
class SpacedLines:
    """Lines to hatch along, as an item asks for them; samples (s,3) on them, apart, line and ranks (s,) as of
    FollowedLines."""

    asked: SurfaceLines
    samples: Floats
    apart: Floats
    line: Ints
    ranks: Floats
    shortest_mm: float = 0.0


def _spaced(
    item: Item,
    hatching: Hatching,
    family: int,
    light: Light,
    placement: Placement,
    tolerance_mm: float,
    crease_angle_deg: float,
) -> SpacedLines:
    """The lines of a family on an item, so close that they do for the darkest places; light: that of isophotes."""
    if hatching.along != "surface":
        field = field_of(hatching.along, family, light)
        flow = flowing_lines(
            item, hatching.along, field, hatching.spacing_mm, tolerance_mm, placement, crease_angle_deg
        )
        asked = SurfaceLines(integral=(KnownCurves(flow.curves),))
        return SpacedLines(asked, flow.samples, flow.apart, flow.line, flow.ranks, SHORTEST * hatching.spacing_mm)
    assert is_parametrised(item.shape)
    count = _count(item.shape, family, hatching.spacing_mm, placement)
    samples, apart = _samples(item.shape, family, count, placement)
    asked = SurfaceLines(columns=count) if family == 0 else SurfaceLines(rows=count)
    return SpacedLines(asked, samples, apart, *_numbered(count, len(samples)))


def _numbered(count: int, samples: int) -> tuple[Ints, Floats]:
    """(s,) the line of each sample, and its rank (s,), of count + 1 lines; the last is the first where they close."""
    line = np.repeat(np.arange(count + 1), samples // (count + 1))
    return line, ranks(line % count, count)


def _ends(scene: Scene, item: int) -> Floats:
    """(3,) the unit normal of the flat ends of an item that is a capped body, zero of what is none."""
    body = capped_quadric_of(scene.items[item].shape)
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
    to, along = (on_page(points, ways[k], placement.page_from_world) for k in (family, 1 - family))
    length = np.linalg.norm(along, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        apart = step * np.abs(cross(to, along)) / length
    return points.reshape(-1, 3), np.nan_to_num(apart, nan=0.0, posinf=0.0).ravel()
