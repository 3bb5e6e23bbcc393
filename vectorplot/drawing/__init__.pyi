from .fill_visibility import visible_fills
from .fills import FillKind, Fills
from .hatching import hatched_fills
from .letters import lettered, typeset
from .painted_fills import placement_of_faces
from .pen_order import PlotEstimate, plot_estimate, travel_mm
from .stroke_curves import curved_strokes
from .strokes import split_long
from .text_along import lettered_along, typeset_along
from .tiles import tiled

__all__ = [
    "FillKind",
    "Fills",
    "PlotEstimate",
    "curved_strokes",
    "hatched_fills",
    "lettered",
    "lettered_along",
    "placement_of_faces",
    "plot_estimate",
    "split_long",
    "tiled",
    "travel_mm",
    "typeset",
    "typeset_along",
    "visible_fills",
]
