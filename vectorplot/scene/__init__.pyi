from .added_lines import even_sections, round_sections, with_lines, without_level_lines
from .cuts import Cut, CutPlane, Explosion
from .face_looks import FaceLook, FaceLooks
from .hatching import Hatching, Stippling
from .item import Item, Pattern, SurfaceNormals
from .labels import Along, AtVertex, Label, OnCurve, OnPage
from .light import Light
from .material import Material
from .page import Page, sheet_size
from .pens import DepthCue, PenOverrides
from .placement import Placement, field_of_vision, fitted_picture
from .scales import BoxAxes, Colouring, Fields
from .scene import Scene
from .surface_lines import (
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    KnownCurves,
    Roads,
    Section,
    Serpentine,
    ShortestPaths,
    SurfaceLines,
    SurfacePath,
    WaterCourses,
    Watersheds,
    even_cosines,
    path_on_surface,
)
from .terrains import TINTS, hill_light, level_sections, round_heights, terrain_mesh, terrain_scene, tinted
from .view import View, look

__all__ = [
    "TINTS",
    "Along",
    "AtVertex",
    "BoxAxes",
    "Colouring",
    "Cut",
    "CutPlane",
    "DepthCue",
    "Explosion",
    "FaceLook",
    "FaceLooks",
    "FieldLines",
    "Fields",
    "GeodesicLines",
    "GeodesicsBetween",
    "Hatching",
    "Item",
    "KnownCurves",
    "Label",
    "Light",
    "Material",
    "OnCurve",
    "OnPage",
    "Page",
    "Pattern",
    "PenOverrides",
    "Placement",
    "Roads",
    "Scene",
    "Section",
    "Serpentine",
    "ShortestPaths",
    "Stippling",
    "SurfaceLines",
    "SurfaceNormals",
    "SurfacePath",
    "View",
    "WaterCourses",
    "Watersheds",
    "even_cosines",
    "even_sections",
    "field_of_vision",
    "fitted_picture",
    "hill_light",
    "level_sections",
    "look",
    "path_on_surface",
    "round_heights",
    "round_sections",
    "sheet_size",
    "terrain_mesh",
    "terrain_scene",
    "tinted",
    "with_lines",
    "without_level_lines",
]
