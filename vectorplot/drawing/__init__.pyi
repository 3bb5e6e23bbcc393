from .drawing import CurvedStrokes, Drawing, Layer, Paths, Pen
from .fills import FillKind, Fills
from .fills_without_overlaps import visible_fills
from .hatching.hatched_fills import hatched_fills
from .lettering.text import Lettering, lettered, typeset
from .lettering.text_along import lettered_along, typeset_along
from .painted_fills import placement_of_faces
from .sheets.contact_sheets import contact_sheet
from .sheets.drawing_scales import DrawingScale
from .sheets.sheet import Sheet
from .strokes.curved_strokes import curved_strokes
from .strokes.long_strokes import split_long
from .strokes.pen_order.order import pen_ordered, travel_mm
from .texts import Texts

__all__ = [
    "CurvedStrokes",
    "Drawing",
    "DrawingScale",
    "FillKind",
    "Fills",
    "Layer",
    "Lettering",
    "Paths",
    "Pen",
    "Sheet",
    "Texts",
    "contact_sheet",
    "curved_strokes",
    "hatched_fills",
    "lettered",
    "lettered_along",
    "pen_ordered",
    "placement_of_faces",
    "split_long",
    "travel_mm",
    "typeset",
    "typeset_along",
    "visible_fills",
]
