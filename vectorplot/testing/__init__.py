"""What users import to verify drawings in their own tests: assertions, an oracle, and shapes that are hard."""

from vectorplot.testing.compare import assert_drawings_equal
from vectorplot.testing.rays import Sight, visible_by_rays
from vectorplot.testing.right import assert_drawing_is_right, edge_points
from vectorplot.testing.shapes import hard_shapes

__all__ = [
    "Sight",
    "assert_drawing_is_right",
    "assert_drawings_equal",
    "edge_points",
    "hard_shapes",
    "visible_by_rays",
]
