"""The contour of a surface: where it turns away from the eye."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import vector
from vectorplot.features.parametric.conditions import CentralContour, ParallelContour
from vectorplot.features.parametric.curve_tracing import Tracing, curves_on_each, samples_of_each
from vectorplot.features.parametric.stacked_conditions import StackedConditions, for_each, stacked
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS

DEFAULT = Tracing()


def contour(surface: Surface, eye: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The points x of a surface with n.(x - eye) = 0, n the unit normal: seen from the eye, it turns away there.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    eye : (3,) array_like of float
        In world coordinates.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines, each point known by its parameters and in space. The side whose normal points away from the eye is on
        the left, in u and v.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers, a grid that is too coarse, a resolution that is not positive.

    Notes
    -----
    What lies behind the eye is traced too. Degenerate: a flat surface whose plane contains the eye has no contour, and
    a doubt says so. At a singular line (the apex of a double cone) the normal jumps: that is no contour.

    Source: Glaeser, section 8.4, equations 25 to 27, figures 13 and 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.contour(surfaces.Sphere(), (4, 0, 0))
    >>> curves.closed.tolist(), bool(np.allclose(curves.points[:, 0], 0.25))  # a circle in front of the centre
    ([True], True)
    """
    return contours([surface], eye, tracing=tracing)[0]


def contours(surfaces: Sequence[Surface], eye: ArrayLike, *, tracing: Tracing = DEFAULT) -> list[SurfaceCurves]:
    """The contours of many surfaces for one eye, as of `contour`: those of placed surfaces traced at once."""
    centre = vector("contour: eye", eye)

    def found(stack: tuple[Surface, ...]) -> list[SurfaceCurves]:
        return _contours(stacked(stack, CentralContour(stack[0], centre)), centre, tracing)

    return for_each(surfaces, tracing.nodes, found)


def _contours(conditions: StackedConditions[CentralContour], centre: Floats, tracing: Tracing) -> list[SurfaceCurves]:
    points = samples_of_each(conditions)
    # Of what has no points f has no size.
    far = [float(np.linalg.norm(own - centre, axis=1).max(initial=0.0)) for own in points]
    large = [float(np.abs(own).max(initial=0.0) + np.abs(centre).max()) for own in points]
    curves = curves_on_each(conditions, far, [ROUNDING_OF_TERMS * size for size in large], tracing)
    return [found if len(own) else no_curves() for found, own in zip(curves, points, strict=True)]


def parallel_contour(surface: Surface, direction: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The points of a surface with n.d = 0, n the unit normal: seen along the direction d, it turns away there.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    direction : (3,) array_like of float
        d, of any length, towards the eye.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines, each point known by its parameters and in space. The side whose normal points towards the eye is on
        the left, in u and v.

    Raises
    ------
    InputError
        For a direction without length, a grid that is too coarse, a resolution that is not positive.

    Notes
    -----
    Degenerate: a surface all seen edge-on (a cylinder along its axis) has no contour, and a doubt says so.

    Source: Glaeser, section 8.4, equation 27 for an eye at infinity.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.parallel_contour(surfaces.Cylinder(), (1, 0, 0))
    >>> curves.closed.tolist(), bool(np.allclose(np.abs(curves.points[:, 1]), 1.0))  # two rulings
    ([False, False], True)
    """
    return parallel_contours([surface], direction, tracing=tracing)[0]


def parallel_contours(
    surfaces: Sequence[Surface], direction: ArrayLike, *, tracing: Tracing = DEFAULT
) -> list[SurfaceCurves]:
    """The contours of many surfaces for one direction, as of `parallel_contour`: those of placed surfaces traced at
    once."""

    def found(stack: tuple[Surface, ...]) -> list[SurfaceCurves]:
        conditions = stacked(stack, ParallelContour(stack[0], direction))
        return curves_on_each(conditions, [1.0] * len(stack), [ROUNDING_OF_TERMS] * len(stack), tracing)

    return for_each(surfaces, tracing.nodes, found)


def contour_in_view(surface: Surface, camera: Camera, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The contour of a surface as a camera sees it, by central or parallel projection."""
    if camera.parallel:
        return parallel_contour(surface, camera.direction, tracing=tracing)
    return contour(surface, camera.eye, tracing=tracing)
