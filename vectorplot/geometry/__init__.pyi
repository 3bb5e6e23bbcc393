from . import ragged
from .clipping import Box, Polygons, Window, clip_lines_2d, clip_polygons_2d, cut_polygons, region_codes
from .convex_bodies import polyhedron_intersection
from .convex_polygons import convex_hull, hull_mesh
from .mesh_repair import repaired
from .polygon_cuts import clipped_by_convex, inside_convex
from .projections import CoordinateSystem, collineate, project
from .regions import polygons_of
from .rotations import axis_frame, rotated_about_line, rotation_about, rotation_x, rotation_z
from .solids import box, has_convex_outline, placed, polyhedron, prism, regular_polygon, revolution
from .unions import polyhedron_union
from .vectors import translated

__all__ = [
    "Box",
    "CoordinateSystem",
    "Polygons",
    "Window",
    "axis_frame",
    "box",
    "clip_lines_2d",
    "clip_polygons_2d",
    "clipped_by_convex",
    "collineate",
    "convex_hull",
    "cut_polygons",
    "has_convex_outline",
    "hull_mesh",
    "inside_convex",
    "placed",
    "polygons_of",
    "polyhedron",
    "polyhedron_intersection",
    "polyhedron_union",
    "prism",
    "project",
    "ragged",
    "region_codes",
    "regular_polygon",
    "repaired",
    "revolution",
    "rotated_about_line",
    "rotation_about",
    "rotation_x",
    "rotation_z",
    "translated",
]
