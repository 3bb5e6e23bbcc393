from .cairo import eps_bytes, pdf_bytes, pdf_pages_bytes, png_bytes, ps_bytes
from .dxf import dxf_bytes
from .json import json_bytes, read_drawing
from .svg import animated_svg_bytes, svg_bytes, svg_text
from .tikz import tikz_bytes

__all__ = [
    "animated_svg_bytes",
    "dxf_bytes",
    "eps_bytes",
    "json_bytes",
    "pdf_bytes",
    "pdf_pages_bytes",
    "png_bytes",
    "ps_bytes",
    "read_drawing",
    "svg_bytes",
    "svg_text",
    "tikz_bytes",
]
