from .intervals import complement, coverage, union
from .predicates import orient2d, orient3d

__all__ = [
    "complement",
    "coverage",
    "orient2d",
    "orient3d",
    "union",
]
