"""The convex hull of points in a plane, round by round.

It begins with the leftmost and the rightmost point. In each round the point that is farthest outside a side becomes a
corner, and what lies inside the new triangle is done with. Source: Glaeser, section 6.1, figure 1, after Bykat.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.geometry import convex_hull
from vectorplot.shading import palette

PAGE_MM = (70.0, 60.0)


def round_of(points: np.ndarray, hull: list[int]) -> list[int]:
    """The hull with one corner more for every side that has points outside."""
    result = []
    for a, b in zip(hull, hull[1:] + hull[:1], strict=True):
        along, arm = points[b] - points[a], points - points[a]
        outside = along[1] * arm[:, 0] - along[0] * arm[:, 1]
        result += [a, int(outside.argmax())] if outside.max() > 0 else [a]
    return result


def picture(points: np.ndarray, hull: list[int]) -> vp.Drawing:
    """The hull so far in yellow, and the points: blue inside it, orange outside, black its corners."""
    a, b = points[hull], points[np.roll(hull, -1)]
    inside = (
        (b - a)[:, None, 0] * (points - a[:, None])[..., 1] >= (b - a)[:, None, 1] * (points - a[:, None])[..., 0]
    ).all(0)
    corner = np.isin(np.arange(len(points)), hull)
    shades = {name: palette(name)[24] for name in ("yellow", "blue", "orange", "black")}
    dots = points[:, None] + 0.6 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    colours = np.where(corner[:, None], shades["black"], np.where(inside[:, None], shades["blue"], shades["orange"]))
    sides = np.stack([a, b], axis=1).reshape(-1, 2)
    fills = Fills.joined(
        Fills.flat(points[hull], np.array([0, len(hull)]), shades["yellow"][None]),
        Fills.flat(sides, 2 * np.arange(len(hull) + 1), np.zeros((len(hull), 3), np.uint8), kind=FillKind.EDGE),
        Fills.flat(dots.reshape(-1, 2), 4 * np.arange(len(points) + 1), colours.astype(np.uint8)),
    )
    return vp.Drawing(*PAGE_MM, (vp.Layer("hull", vp.Pen(), (fills,)),), title="Convex hull")


def main(folder: Path) -> None:
    random = np.random.default_rng(4)
    points = np.clip(random.normal(size=(60, 2)) * (11, 9) + (35, 30), 3, (67, 57))
    hull = [int(points[:, 0].argmin()), int(points[:, 0].argmax())]
    rounds = [hull]
    while (larger := round_of(points, rounds[-1])) != rounds[-1]:
        rounds.append(larger)
    for number in range(3):
        vp.save(picture(points, rounds[number + 1]), folder / f"convex_hull_{number + 1}.svg")

    assert len(rounds) == 4 and rounds[-1] == convex_hull(points).tolist()
    a, b = points[rounds[-1]], points[np.roll(rounds[-1], -1)]
    along, arm, after = b - a, points - a[:, None], np.roll(b - a, -1, axis=0)
    assert (along[:, 0] * after[:, 1] > along[:, 1] * after[:, 0]).all(), "all corners turn left"
    left = along[:, None, 0] * arm[..., 1] - along[:, None, 1] * arm[..., 0]
    assert (left > -1e-9).all(), "no point is outside"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
