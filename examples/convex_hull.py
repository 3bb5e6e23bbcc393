"""The convex hull of points in a plane, round by round.

It begins with the leftmost and the rightmost point. In each round the point that is farthest outside a side becomes a
corner, and what lies inside the new triangle is done with. Red are the new corners with their distances from the sides,
hollow the points that are still outside. Source: Glaeser, section 6.1, figure 1, after Bykat.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from diagrams import BLUE, GREY, INK, RED, SAND, SKY, circle, layer, polygons, strokes

import vectorplot as vp
from vectorplot.geometry import convex_hull

PAGE_MM = (84.0, 72.0)


def round_of(points: np.ndarray, hull: list[int]) -> list[int]:
    """The hull with one corner more for every side that has points outside."""
    result = []
    for a, b in zip(hull, hull[1:] + hull[:1], strict=True):
        along, arm = points[b] - points[a], points - points[a]
        outside = along[1] * arm[:, 0] - along[0] * arm[:, 1]
        result += [a, int(outside.argmax())] if outside.max() > 0 else [a]
    return result


def picture(points: np.ndarray, before: list[int], hull: list[int]) -> vp.Drawing:
    """The hull of the round before and what this one adds."""
    a, b = points[hull], points[np.roll(hull, -1)]
    left = (b - a)[:, None, 0] * (points - a[:, None])[..., 1] - (b - a)[:, None, 1] * (points - a[:, None])[..., 0]
    inside, new = (left >= -1e-9).all(axis=0), [k for k in hull if k not in before]
    drops, added = [], []
    for k in new if before else ():
        one, two = hull[hull.index(k) - 1], hull[(hull.index(k) + 1) % len(hull)]
        along = (points[two] - points[one]) / np.linalg.norm(points[two] - points[one])
        drops.append(np.array([points[k], points[one] + along * ((points[k] - points[one]) @ along)]))
        added.append(points[[one, k, two]])
    outer = [circle(point, 0.85) for point in points[~inside]]
    old = [points[before]] if len(before) > 2 else []
    layers = (
        layer("hull", polygons([*old, *added], [*[SAND] * len(old), *[SKY] * len(added)])),
        layer("before", strokes([points[before]] if before else [], closed=True), INK, 0.25),
        layer("now", strokes([points[hull]], closed=True), BLUE, 0.5),
        layer("distances", strokes(drops), RED, 0.3),
        layer("outside", strokes(outer, closed=True), INK, 0.25),
        layer("inside", polygons([circle(point, 0.75) for point in points[inside]], GREY)),
        layer("corners", polygons([circle(points[k], 1.2) for k in hull], [RED if k in new else INK for k in hull])),
    )
    return vp.Drawing(*PAGE_MM, layers, title="Convex hull")


def main(folder: Path) -> None:
    random = np.random.default_rng(4)
    points = np.clip(random.normal(size=(60, 2)) * (11, 9) + (35, 30), 3, (67, 57)) * 1.2
    rounds = [[int(points[:, 0].argmin()), int(points[:, 0].argmax())]]
    while (larger := round_of(points, rounds[-1])) != rounds[-1]:
        rounds.append(larger)
    for number, (before, after) in enumerate(pairwise([[], *rounds])):
        vp.save(picture(points, before, after), folder / f"convex_hull_{number + 1}.svg")

    assert len(rounds) == 4 and rounds[-1] == convex_hull(points).tolist()
    a, b = points[rounds[-1]], points[np.roll(rounds[-1], -1)]
    along, arm, after = b - a, points - a[:, None], np.roll(b - a, -1, axis=0)
    assert (along[:, 0] * after[:, 1] > along[:, 1] * after[:, 0]).all(), "all corners turn left"
    left = along[:, None, 0] * arm[..., 1] - along[:, None, 1] * arm[..., 0]
    assert (left > -1e-9).all(), "no point is outside"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
