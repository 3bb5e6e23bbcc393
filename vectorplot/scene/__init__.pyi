from .paper import sheet_size
from .scene import Item, Light, Material, Page, Pattern, Scene
from .surface_lines import Section, SurfaceLines, even_cosines
from .view import View, look

__all__ = [
    "Item",
    "Light",
    "Material",
    "Page",
    "Pattern",
    "Scene",
    "Section",
    "SurfaceLines",
    "View",
    "even_cosines",
    "look",
    "sheet_size",
]
