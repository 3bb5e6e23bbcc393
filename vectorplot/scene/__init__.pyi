from .cuts.cut import Cut, CutPlane
from .cuts.explosion import Explosion
from .depth_cue import DepthCue
from .fields import Fields
from .hatching import Hatching, Stippling
from .item import Item, Pattern
from .light import Light
from .lines.added_lines import even_sections, round_sections, with_lines, without_level_lines
from .lines.integral_lines import FieldLines, GeodesicLines, GeodesicsBetween, KnownCurves, ShortestPaths
from .material import Material
from .naming.labels import Along, AtVertex, Label, OnCurve, OnPage
from .naming.scales import BoxAxes, Colouring
from .pages.inks import Inks
from .pages.page import Page
from .pages.paper import sheet_size
from .placement import Placement, field_of_vision, fitted_picture
from .scene import Scene
from .surface_lines import Section, SurfaceLines, SurfacePath, even_cosines, path_on_surface
from .surface_normals import SurfaceNormals
from .terrains.level_lines import level_sections, round_heights
from .terrains.terrain_lines import Roads, Serpentine, WaterCourses, Watersheds
from .terrains.terrain_mesh import terrain_mesh, terrain_scene
from .terrains.tints import TINTS, hill_light, tinted
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
    "FieldLines",
    "Fields",
    "GeodesicLines",
    "GeodesicsBetween",
    "Hatching",
    "Inks",
    "Item",
    "KnownCurves",
    "Label",
    "Light",
    "Material",
    "OnCurve",
    "OnPage",
    "Page",
    "Pattern",
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
