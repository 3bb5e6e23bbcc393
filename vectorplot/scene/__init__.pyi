from .added_lines import even_sections, round_sections, with_lines
from .annotations import field_arrows
from .colour_scales import BoxAxes, Colouring, Fields, ScaleBar
from .cuts import Cut, CutPlane
from .face_looks import FaceLook, FaceLooks
from .item import SurfaceNormals
from .page import SheetSettings
from .pens import DepthCue, PenOverrides
from .subdivided import subdivided_item
from .surface_lines import (
    FieldContours,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    NamedVectors,
    Roads,
    Serpentine,
    ShortestPaths,
    WaterCourses,
    Watersheds,
    even_cosines,
    round_heights,
)
from .terrains import hill_light, level_sections, terrain_mesh, terrain_scene, tinted
from .view import look

__all__ = [
    "BoxAxes",
    "Colouring",
    "Cut",
    "CutPlane",
    "DepthCue",
    "FaceLook",
    "FaceLooks",
    "FieldContours",
    "FieldLines",
    "Fields",
    "GeodesicLines",
    "GeodesicsBetween",
    "NamedVectors",
    "PenOverrides",
    "Roads",
    "ScaleBar",
    "Serpentine",
    "SheetSettings",
    "ShortestPaths",
    "SurfaceNormals",
    "WaterCourses",
    "Watersheds",
    "even_cosines",
    "even_sections",
    "field_arrows",
    "hill_light",
    "level_sections",
    "look",
    "round_heights",
    "round_sections",
    "subdivided_item",
    "terrain_mesh",
    "terrain_scene",
    "tinted",
    "with_lines",
]
