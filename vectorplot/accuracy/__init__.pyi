from .approximation import Approximation, Study, Way
from .results import Accuracy, ErrorCurve, Sample, plot
from .verb import APPROXIMATIONS, measured

__all__ = [
    "APPROXIMATIONS",
    "Accuracy",
    "Approximation",
    "ErrorCurve",
    "Sample",
    "Study",
    "Way",
    "measured",
    "plot",
]
