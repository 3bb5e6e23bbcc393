from .hatching import Hatching
from .integral_lines import FieldLines, GeodesicLines
from .paper import sheet_size
from .placement import Placement, field_of_vision, fitted_picture
from .scene import Item, Light, Material, Page, Pattern, Scene
from .surface_lines import Section, SurfaceLines, SurfacePath, even_cosines, path_on_surface
from .view import View, look

__all__ = [
    "FieldLines",
    "GeodesicLines",
    "Hatching",
    "Item",
    "Light",
    "Material",
    "Page",
    "Pattern",
    "Placement",
    "Scene",
    "Section",
    "SurfaceLines",
    "SurfacePath",
    "View",
    "even_cosines",
    "field_of_vision",
    "fitted_picture",
    "look",
    "path_on_surface",
    "sheet_size",
]
