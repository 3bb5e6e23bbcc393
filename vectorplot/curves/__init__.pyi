from .curve import Curve
from .families import Circle, Helix, Line, Loxodrome, cylinder_intersection
from .placed_curves import PlacedCurve, curve_of_function
from .splines import (
    AkimaSpline,
    ApproximatingSpline,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    SplineKind,
    nurbs_curve,
    spline_curve,
)

__all__ = [
    "AkimaSpline",
    "ApproximatingSpline",
    "BSpline",
    "Circle",
    "CubicSpline",
    "Curve",
    "Helix",
    "InterpolatingSpline",
    "Line",
    "Loxodrome",
    "PlacedCurve",
    "SplineKind",
    "curve_of_function",
    "cylinder_intersection",
    "nurbs_curve",
    "spline_curve",
]
