"""Curves traced on parametrised surfaces as the engine takes them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import from_components
from vectorplot.visibility.smooth.sheets.directed_curves import DirectedCurves
from vectorplot.visibility.smooth.sheets.family import ConditionCurves, ParameterCurves, RimCurves
from vectorplot.visibility.smooth.sheets.meeting_families import FaceCurves
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

OnSurface = ConditionCurves | ParameterCurves | DirectedCurves | RimCurves | FaceCurves


def as_curves(
    found: SurfaceCurves, kind: LineKind, item: int, family: OnSurface, second_places: Floats | None = None
) -> Curves:
    """Curves of a surface with closed ones led back to their first point; second_places (n,3) of the points found, or
    else their directions."""
    rounds = closed_round(found)
    index = rounds.index
    places = from_components(found.u.take(index), found.v.take(index), 0.0)
    size = np.stack(family.surface.surface_at(places[rounds.again]).domain.size, axis=-1)
    places[rounds.again, :2] += found.turns[found.closed] * size
    if second_places is None:
        second_places = from_components(found.directions[:, 0], found.directions[:, 1], 0.0)
    many = len(found)
    whole = np.full(many, item, dtype=np.intp)
    return Curves(
        found.points.take(index, axis=0),
        places,
        second_places.take(index, axis=0),
        rounds.offsets,
        found.closed,
        np.full(many, int(kind)),
        whole,
        np.zeros(many, dtype=np.intp),
        found.levels if kind in (LineKind.ISOPHOTE, LineKind.SECTION, LineKind.INDEX) else np.zeros(many),
        (family,),
    )
