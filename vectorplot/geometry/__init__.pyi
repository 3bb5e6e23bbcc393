from . import ragged
from .budget import Budget
from .camera import Camera, focal_length_mm
from .clipping import Box, Polygons, Window, clip_lines_2d, clip_polygons_2d, cut_polygons, region_codes
from .convex_bodies import convex_revolution_parts, polyhedron_intersection
from .convex_polygons import convex_hull, hull_mesh
from .mesh import Mesh
from .mesh_repair import mesh_report, repaired, welded
from .polygon_cuts import clipped_by_convex, inside_convex
from .polylines import Strokes
from .projections import CoordinateSystem, collineate, project, projection_of
from .regions import polygons_of
from .rotations import (
    axis_frame,
    euler_angles,
    inverse_rotation,
    rotated_about_line,
    rotation_about,
    rotation_x,
    rotation_z,
)
from .solids import box, has_convex_outline, placed, polyhedron, prism, regular_polygon, revolution
from .vectors import angle, length, normalize, translated
from .winding import edge_uses, face_barycentres, is_closed_oriented

__all__ = [
    "Box",
    "Budget",
    "Camera",
    "CoordinateSystem",
    "Mesh",
    "Polygons",
    "Strokes",
    "Window",
    "angle",
    "axis_frame",
    "box",
    "clip_lines_2d",
    "clip_polygons_2d",
    "clipped_by_convex",
    "collineate",
    "convex_hull",
    "convex_revolution_parts",
    "cut_polygons",
    "edge_uses",
    "euler_angles",
    "face_barycentres",
    "focal_length_mm",
    "has_convex_outline",
    "hull_mesh",
    "inside_convex",
    "inverse_rotation",
    "is_closed_oriented",
    "length",
    "mesh_report",
    "normalize",
    "placed",
    "polygons_of",
    "polyhedron",
    "polyhedron_intersection",
    "prism",
    "project",
    "projection_of",
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
    "welded",
]
