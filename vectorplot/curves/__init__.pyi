from .bezier.arcs import EllipseArc, arc_path
from .bezier.elliptic_arcs import EllipseArcs
from .bezier.fit import fitted_curve, fitted_paths
from .bezier.paths import BezierPath, BezierPaths
from .curve import Curve, is_curve
from .cut_curve import CutCurve
from .families.circle import Circle
from .families.cylinder_intersections import cylinder_branches, cylinder_intersection
from .families.helix import Helix
from .families.line import Line
from .families.loxodrome import Loxodrome
from .function_curve import FunctionCurve, curve_of_function
from .placed_curve import PlacedCurve
from .splines.basis import Basis
from .splines.kinds import AkimaSpline, ApproximatingSpline, BSpline, CubicSpline, InterpolatingSpline, SplineKind
from .splines.spline_curve import SplineCurve, nurbs_curve, spline_curve

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
