"""Focal lengths of miniature cameras and fields of vision.

Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.
"""

from __future__ import annotations

import numpy as np

from vectorplot.errors import InputError
from vectorplot.geometry.elementary import arctan, tan

NEGATIVE_MM = (36.0, 24.0)
"""Width and height of a miniature camera's negative."""

NATURAL_DEG = (15.0, 40.0)
"""Fields of vision that look natural."""

WIDEST_DEG, NARROWEST_DEG = 60.0, 10.0
"""Wider fields distort; narrower ones look like a telephoto lens."""


def field_of_vision_deg(focal_length_mm: float) -> float:
    """The angle over the height of the picture of a miniature camera.

    Parameters
    ----------
    focal_length_mm : float
        Of the lens, in mm.

    Returns
    -------
    float
        In degrees.

    Raises
    ------
    InputError
        For a focal length that is not positive and finite.

    Notes
    -----
    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> round(geometry.field_of_vision_deg(50.0), 3)
    26.991
    """
    return _angle_deg(NEGATIVE_MM[1], focal_length_mm)


def diagonal_field_of_vision_deg(focal_length_mm: float) -> float:
    """The angle over the diagonal of the picture of a miniature camera.

    Parameters
    ----------
    focal_length_mm : float
        Of the lens, in mm.

    Returns
    -------
    float
        In degrees.

    Raises
    ------
    InputError
        For a focal length that is not positive and finite.

    Notes
    -----
    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> round(geometry.diagonal_field_of_vision_deg(50.0), 3)
    46.793
    """
    return _angle_deg(float(np.hypot(*NEGATIVE_MM)), focal_length_mm)


def focal_length_mm(fov_deg: float) -> float:
    """The focal length of a miniature camera with some angle over the height of the picture.

    Parameters
    ----------
    fov_deg : float
        In degrees.

    Returns
    -------
    float
        In mm.

    Raises
    ------
    InputError
        For an angle that is not between 0 and 180 degrees.

    Notes
    -----
    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> round(geometry.focal_length_mm(26.991), 2)
    50.0
    """
    if not 0.0 < fov_deg < 180.0:
        raise InputError(f"field of vision {fov_deg:g} must lie between 0 and 180 degrees")
    return NEGATIVE_MM[1] / 2.0 / float(tan(np.radians(fov_deg) / 2.0))


def lens_advice(fov_deg: float) -> str | None:
    """One line about a field of vision that will not look natural.

    Parameters
    ----------
    fov_deg : float
        Over the height of the picture, in degrees.

    Returns
    -------
    str or None
        None for a sensible one.

    Notes
    -----
    Source: Glaeser, section 2.2.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.lens_advice(75.0)
    'a field of vision of 75 degrees distorts; 15 to 40 degrees look natural'
    >>> geometry.lens_advice(30.0) is None
    True
    """
    natural = f"{NATURAL_DEG[0]:g} to {NATURAL_DEG[1]:g} degrees look natural"
    if fov_deg > WIDEST_DEG:
        return f"a field of vision of {fov_deg:g} degrees distorts; {natural}"
    if fov_deg < NARROWEST_DEG:
        return f"a field of vision of {fov_deg:g} degrees is that of a telephoto lens; {natural}"
    return None


def _angle_deg(size_mm: float, focal_mm: float) -> float:
    if not 0.0 < focal_mm < np.inf:
        raise InputError(f"focal length {focal_mm:g} mm must be positive and finite")
    return float(np.degrees(2.0 * arctan(size_mm / 2.0 / focal_mm)))
