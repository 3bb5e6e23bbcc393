from .arcs import EllipseArc, EllipseArcs, arc_path
from .bezier import BezierPath, BezierPaths
from .bezier_fit import fitted_curve, fitted_paths
from .curve import Curve, is_curve
from .cut_curve import CutCurve
from .families import Circle, Helix, Line, Loxodrome, cylinder_branches, cylinder_intersection
from .placed_curves import FunctionCurve, PlacedCurve, curve_of_function
from .splines import (
    AkimaSpline,
    ApproximatingSpline,
    Basis,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    SplineCurve,
    SplineKind,
    nurbs_curve,
    spline_curve,
)

__all__ = [
    "AkimaSpline",
    "ApproximatingSpline",
    "BSpline",
    "Basis",
    "BezierPath",
    "BezierPaths",
    "Circle",
    "CubicSpline",
    "Curve",
    "CutCurve",
    "EllipseArc",
    "EllipseArcs",
    "FunctionCurve",
    "Helix",
    "InterpolatingSpline",
    "Line",
    "Loxodrome",
    "PlacedCurve",
    "SplineCurve",
    "SplineKind",
    "arc_path",
    "curve_of_function",
    "cylinder_branches",
    "cylinder_intersection",
    "fitted_curve",
    "fitted_paths",
    "is_curve",
    "nurbs_curve",
    "spline_curve",
]
