"""Seven points as control points of B-splines: of orders 2 to 6, with a repeated point, closed, and with a weight.

Order 2 is the polygon, order 3 touches its sides, and the higher the order, the farther the curve keeps away. A point
that stands there once less than the order is on the curve, and a weight attracts it smoothly. Source: Glaeser, section
9.2, figures 4 and 5.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import BSpline, Curve, PlacedCurve, nurbs_curve, spline_curve

POINTS = np.array([(0, 0, 0), (1, 0, 4), (4, 0, 5), (5, 1, -2), (8, 1, -2), (10, 0, 4), (11, 0, 0)], dtype=float)
COLOURS = ("red", "orange", "green", "cyan", "blue")


def with_polygon(name: str, place: int, curves: list[Curve], closed: bool = False) -> list[vp.Item]:
    """Curves and the polygon of the control points, side by side with others."""
    shift = np.array([14.0 * (place % 2), 0.0, -10.0 * (place // 2)])
    polygon = spline_curve(POINTS, BSpline(2, closed))
    coloured = zip(COLOURS, curves, strict=False)
    shown = [vp.Item(name, polygon, "lightgray"), *(vp.Item(f"{name} {word}", curve, word) for word, curve in coloured)]
    eye = np.eye(3)
    return [vp.Item(item.name, PlacedCurve(item.shape, eye, shift), item.colour) for item in shown]


def main(folder: Path) -> None:
    orders = [spline_curve(POINTS, BSpline(order)) for order in (3, 4, 5, 6)]
    repeated = [spline_curve(np.repeat(POINTS, [1, 1, times, 1, 1, 1, 1], axis=0), BSpline(4)) for times in (1, 2, 3)]
    rounds = [spline_curve(POINTS, BSpline(order, closed=True)) for order in (3, 4, 6)]
    weighted = [nurbs_curve(POINTS, [1, 1, weight, 1, 1, 1, 1]) for weight in (1, 3, 12)]
    items = [
        *with_polygon("ORDERS", 0, orders),
        *with_polygon("REPEATED", 1, repeated),
        *with_polygon("CLOSED", 2, rounds, closed=True),
        *with_polygon("WEIGHTS", 3, weighted),
    ]
    camera = vp.Camera((12, -40, 4), target=(12, 0, -4), parallel=True)
    drawing = vp.draw(vp.Scene(tuple(items), title="B-splines"), camera, page=vp.Page(190, 130, 6), layers="colour")
    vp.save(drawing, folder / "b_splines.svg")

    near = [
        np.linalg.norm(curve.points(np.linspace(0, curve.end, 1201)) - POINTS[2], axis=1).min() for curve in repeated
    ]
    assert near[0] > near[1] > 0.01 and near[2] < 1e-12, "three times, and it is on the curve of order 4"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
