from .intervals import complement, coverage, union
from .predicates import orient2d, orient3d, polygon_orientation

__all__ = [
    "complement",
    "coverage",
    "orient2d",
    "orient3d",
    "polygon_orientation",
    "union",
]
