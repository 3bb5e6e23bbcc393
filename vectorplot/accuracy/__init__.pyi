from .approximation import Approximation, Study, Way
from .catalogue import APPROXIMATIONS
from .curves_of_error import Accuracy, ErrorCurve, Sample
from .error_plots import plot
from .measuring import measured

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
