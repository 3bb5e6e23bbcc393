from .added_lines import even_sections, round_sections, with_lines
from .cuts import Cut, CutPlane
from .face_looks import FaceLook, FaceLooks
from .hatching import Hatching, Stippling
from .item import Item, Pattern, SurfaceNormals
from .labels import Along, AtVertex, Label, OnCurve, OnPage
from .light import Light
from .material import Material
from .page import Page
from .pens import DepthCue
from .placement import field_of_vision
from .scales import BoxAxes, Colouring, Fields
from .scene import Scene
from .surface_lines import (
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    Roads,
    Section,
    Serpentine,
    ShortestPaths,
    SurfaceLines,
    WaterCourses,
    Watersheds,
    even_cosines,
    round_heights,
)
from .terrains import TINTS, hill_light, level_sections, terrain_mesh, terrain_scene, tinted
from .view import look

__all__ = [
    "TINTS",
    "Along",
    "AtVertex",
    "BoxAxes",
    "Colouring",
    "Cut",
    "CutPlane",
    "DepthCue",
    "FaceLook",
    "FaceLooks",
    "FieldLines",
    "Fields",
    "GeodesicLines",
    "GeodesicsBetween",
    "Hatching",
    "Item",
    "Label",
    "Light",
    "Material",
    "OnCurve",
    "OnPage",
    "Page",
    "Pattern",
    "Roads",
    "Scene",
    "Section",
    "Serpentine",
    "ShortestPaths",
    "Stippling",
    "SurfaceLines",
    "SurfaceNormals",
    "WaterCourses",
    "Watersheds",
    "even_cosines",
    "even_sections",
    "field_of_vision",
    "hill_light",
    "level_sections",
    "look",
    "round_heights",
    "round_sections",
    "terrain_mesh",
    "terrain_scene",
    "tinted",
    "with_lines",
]
