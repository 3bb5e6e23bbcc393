from .certificates import Certificate, assert_certified, certificate
from .curves import (
    assert_closed,
    assert_contour,
    assert_isophote,
    assert_on_both,
    assert_on_surface,
    assert_same_curve,
    branch_count,
    curves_in_space,
    hausdorff,
)
from .drawings import assert_drawing_is_right, assert_drawings_equal, edge_points
from .integral_curves import assert_geodesic, assert_integral_curve
from .rays import visible_by_rays
from .shapes import hard_shapes

__all__ = [
    "Certificate",
    "assert_certified",
    "assert_closed",
    "assert_contour",
    "assert_drawing_is_right",
    "assert_drawings_equal",
    "assert_geodesic",
    "assert_integral_curve",
    "assert_isophote",
    "assert_on_both",
    "assert_on_surface",
    "assert_same_curve",
    "branch_count",
    "certificate",
    "curves_in_space",
    "edge_points",
    "hard_shapes",
    "hausdorff",
    "visible_by_rays",
]
