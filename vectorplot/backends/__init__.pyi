from .cairo.pages import pdf_pages_bytes
from .cairo.surfaces import eps_bytes, pdf_bytes, png_bytes, ps_bytes
from .dxf.dxf_document import dxf_bytes
from .json.json_document import json_bytes, read_drawing
from .svg.animated import animated_svg_bytes
from .svg.svg_document import svg_bytes, svg_text
from .tikz.tikz_picture import tikz_bytes

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
