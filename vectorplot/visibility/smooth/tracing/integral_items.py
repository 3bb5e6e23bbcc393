"""The integral curves that an item asks for."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.integral.curvature_fields import AsymptoticDirections, PrincipalDirections
from vectorplot.features.integral.geodesics_between import geodesics_between
from vectorplot.features.integral.integral_curves import geodesics, integral_curves
from vectorplot.features.integral.spacing.evenly_spaced import DRAWN, evenly_spaced_curves
from vectorplot.features.integral.tangent_fields import SteepestSlope
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.surface_curves import SurfaceCurves, together
from vectorplot.scene.item import Item
from vectorplot.scene.lines.integral_lines import (
    ON_SURFACES,
    USUAL_APART,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    IntegralLines,
    KnownCurves,
    ShortestPaths,
    check_points,
)
from vectorplot.scene.view import View
from vectorplot.surfaces.placed_surface import placed_once
from vectorplot.surfaces.surface import Domain, Surface


def integral_curves_in_view(
    view: View, item: Item, surface: Surface, lines: IntegralLines, tracing: Tracing
) -> SurfaceCurves:
    """Integral curves of a surface in the view's coordinates, found in the world, where fields know their directions.

    Warnings: where there are none. Errors: InputError, with the item's name, for lines that are too close together, or
    begin at points in space.
    """
    world = placed_once(surface, view.scale * view.axes, view.centre, np.zeros(3))
    picture = tracing.picture

    def image(points: Floats) -> Floats:
        own = view.points_of(points).T
        return own if picture is None else picture(own)

    try:
        found = integral_lines(world, lines, replace(tracing, picture=image))
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    if not len(found) and not isinstance(lines, KnownCurves):
        warnings.warn(f"{item.name}: {_why_none(lines)}", InputWarning, stacklevel=2)
    return replace(found, points=np.ascontiguousarray(view.points_of(found.points).T))


def _why_none(lines: IntegralLines) -> str:
    """Why a surface has no such curves."""
    if not isinstance(lines, FieldLines):
        return "no geodesics from these places: they lie beyond the surface, or lead nowhere"
    if isinstance(lines.field, PrincipalDirections):
        why = "no lines of curvature: it is flat, or round as a ball"
    elif isinstance(lines.field, AsymptoticDirections):
        why = "no asymptotic lines: it is nowhere saddle-shaped"
    elif isinstance(lines.field, SteepestSlope):
        why = "no slope lines: it is level"
    else:
        why = "no lines of a field: it has no direction there"
    return why + ", or these places lie beyond the surface" * bool(lines.through)


def integral_lines(surface: Surface, lines: IntegralLines, tracing: Tracing) -> SurfaceCurves:
    """The curves of a surface of the world that are asked for; those that begin outside its domain are left out.

    Errors: InputError for lines that are too close together, or begin at points in space, shortest paths.
    """
    if isinstance(lines, ShortestPaths):
        raise InputError("shortest paths are for polyhedra only")
    if isinstance(lines, KnownCurves):
        if not isinstance(lines.curves, SurfaceCurves):
            raise InputError("known curves: those of a mesh, on a surface with parameters u and v")
        return lines.curves
    check_points(lines, ON_SURFACES)
    if isinstance(lines, GeodesicLines):
        rows = np.array(lines.starts).reshape(-1, 3)
        rows = rows[_within(surface.domain, rows)]
        return geodesics(surface, rows[:, :2], rows[:, 2], length=lines.length, accuracy=DRAWN, tracing=tracing)
    if isinstance(lines, GeodesicsBetween):
        rows = np.array(lines.pairs).reshape(-1, 4)
        rows = rows[_within(surface.domain, rows) & _within(surface.domain, rows[:, 2:])]
        return together(
            [
                geodesics_between(surface, row[:2], row[2:], most=lines.most, longest=lines.length, tracing=tracing)
                for row in rows
            ]
        )
    if lines.through:
        rows = np.array(lines.through)
        rows = rows[_within(surface.domain, rows)]
        return integral_curves(surface, lines.field, rows, length=lines.length, accuracy=DRAWN, tracing=tracing)
    apart = USUAL_APART * extent(surface)[0] if lines.apart is None else lines.apart
    return evenly_spaced_curves(surface, lines.field, apart, accuracy=DRAWN, tracing=tracing)


def _within(domain: Domain, rows: Floats) -> Bools:
    """(k,) which of the rows begin with parameters within the domain."""
    u, v = rows[:, 0], rows[:, 1]
    good = domain.closed_u | ((u >= domain.u_start) & (u <= domain.u_end))
    return np.asarray(good & (domain.closed_v | ((v >= domain.v_start) & (v <= domain.v_end))))
