from .cairo.surfaces import eps_bytes, pdf_bytes, png_bytes, ps_bytes
from .json.document import json_bytes, read_drawing
from .svg.document import svg_bytes, svg_text

__all__ = [
    "eps_bytes",
    "json_bytes",
    "pdf_bytes",
    "png_bytes",
    "ps_bytes",
    "read_drawing",
    "svg_bytes",
    "svg_text",
]
