from .bezier.arcs import EllipseArc, arc_path
from .bezier.elliptic_arcs import EllipseArcs
from .bezier.fit import fitted_curve, fitted_paths
from .bezier.paths import BezierPath, BezierPaths
from .circle import Circle
from .curve import Curve, is_curve
from .cylinder_intersections import cylinder_branches, cylinder_intersection
from .function import FunctionCurve, curve_of_function
from .helix import Helix
from .line import Line
from .loxodrome import Loxodrome
from .placed import PlacedCurve

__all__ = [
    "BezierPath",
    "BezierPaths",
    "Circle",
    "Curve",
    "EllipseArc",
    "EllipseArcs",
    "FunctionCurve",
    "Helix",
    "Line",
    "Loxodrome",
    "PlacedCurve",
    "arc_path",
    "curve_of_function",
    "cylinder_branches",
    "cylinder_intersection",
    "fitted_curve",
    "fitted_paths",
    "is_curve",
]
