"""What users import to verify drawings in their own tests: assertions, an oracle, and shapes that are hard."""

from vectorplot.testing.compare import assert_drawings_equal
from vectorplot.testing.curve_distance import hausdorff
from vectorplot.testing.curves import (
    BranchCount,
    assert_closed,
    assert_contour,
    assert_isophote,
    assert_on_both,
    assert_on_surface,
    assert_same_curve,
    branch_count,
)
from vectorplot.testing.drawing_checks import assert_drawing_is_right, edge_points
from vectorplot.testing.polylines import curves_in_space
from vectorplot.testing.rays.sight import Sight, visible_by_rays
from vectorplot.testing.shapes import hard_shapes

__all__ = [
    "BranchCount",
    "Sight",
    "assert_closed",
    "assert_contour",
    "assert_drawing_is_right",
    "assert_drawings_equal",
    "assert_isophote",
    "assert_on_both",
    "assert_on_surface",
    "assert_same_curve",
    "branch_count",
    "curves_in_space",
    "edge_points",
    "hard_shapes",
    "hausdorff",
    "visible_by_rays",
]
