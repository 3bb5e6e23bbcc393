from .approximation import Approximation, Study, Way
from .results import plot
from .verb import measured

__all__ = [
    "Approximation",
    "Study",
    "Way",
    "measured",
    "plot",
]
