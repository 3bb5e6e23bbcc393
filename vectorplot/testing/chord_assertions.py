"""Assertion about the chords of curves that follow a field of directions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.integral.sites import Sites, unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.surface import Surface
from vectorplot.testing.curves import places_near


class _Ends(NamedTuple):
    """The angles (k,) of chords with the field at one of their ends, NaN where it has no direction there, and the
    direction (k,3) of it that is meant."""

    angle: Floats
    direction: Floats


def assert_chords(lines: list[Floats], surface: Surface, field: TangentField, tolerance: float) -> None:
    """Nothing, where every chord of polylines (n,3) on a surface runs as the field does: off it by no more than the
    field turns along it, and an angle.

    A chord is a mean of the directions in which its curve runs: where these turn one way it is nearer to those at both
    ends than they are to each other; where they turn there and back, nearer than the one in the middle. Points may be
    off the surface by the tolerance times its extent, and chords by as much of their length. Ends without a direction
    are not looked at.
    """
    begin = np.concatenate([line[:-1] for line in lines])
    chords = np.concatenate([np.diff(line, axis=0) for line in lines])
    length = norm(chords)
    begin, chords, length = begin[length > 0.0], chords[length > 0.0], length[length > 0.0]
    extent, first = _directions(begin, chords, surface, field)
    _, last = _directions(begin + chords, chords, surface, field)
    error = np.fmax(first.angle, last.angle) - _angles(first.direction, last.direction)
    noise = tolerance * extent / length
    doubtful = np.flatnonzero(error > tolerance + noise)
    if len(doubtful):
        _, middle = _directions(begin[doubtful] + 0.5 * chords[doubtful], chords[doubtful], surface, field)
        turns = [_angles(end.direction[doubtful], middle.direction) for end in (first, last)]
        farthest = np.fmax(first.angle, last.angle)[doubtful]
        error[doubtful] = np.fmin(error[doubtful], farthest - np.fmax(*turns))
    over = np.nan_to_num(error - noise, nan=-np.inf)
    k = int(np.argmax(over))
    where = ", ".join(f"{x:.10g}" for x in begin[k])
    assert over[k] <= tolerance, (
        f"{int((over > tolerance).sum())} of {len(over)} chords are not on a curve of the field: the angle is "
        f"{error[k]:.4g} more than it turns at the worst, behind ({where}), tolerance {tolerance:.4g}"
    )


def _directions(points: Floats, chords: Floats, surface: Surface, field: TangentField) -> tuple[float, _Ends]:
    """The extent of a surface; which of a field's directions at points (k,3) is nearest to chords (k,3), and by which
    angle."""
    places = places_near(surface, points)
    assert places.parameters is not None
    row = np.arange(len(points))
    u, v = places.parameters[row, np.argmin(places.distance, axis=1)].T
    candidates = field.tangents(Sites(surface, np.ascontiguousarray(u), np.ascontiguousarray(v)))
    angles = _angles(candidates, np.broadcast_to(unit(chords), candidates.shape))
    best = np.argmin(np.where(np.isfinite(angles), angles, np.inf), axis=0)
    return places.extent, _Ends(angles[best, row], candidates[best, row])


def _angles(a: Floats, b: Floats) -> Floats:
    """(...) between straight lines with unit directions (...,3)."""
    return np.asarray(arctan2(norm(cross(a, b)), np.abs(dot(a, b))))
