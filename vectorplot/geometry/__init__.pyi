from . import ragged
from .bodies.bodies_of_revolution import revolution
from .bodies.prisms import prism, regular_polygon
from .bodies.solids import box, has_convex_outline, placed, polyhedron
from .budget import Budget, budget_of
from .cameras.camera import Camera
from .cameras.collineation import collineate, project, uncollineate, unproject
from .cameras.coordinate_system import CoordinateSystem
from .cameras.lens import diagonal_field_of_vision_deg, field_of_vision_deg, focal_length_mm, lens_advice
from .cameras.pixel_window import PixelWindow
from .cameras.unit_projection import Projection, projection_of
from .clipping.clip_windows import Box, Window, region_codes
from .clipping.clipped_lines import ClippedLines, clip_and_draw, clip_lines_2d, clip_lines_3d
from .clipping.clipped_polygons import Polygons, clip_polygons_2d, clip_polygons_3d, cut_polygons
from .convex.convex_hulls import convex_hull, hull_mesh
from .convex.convex_parts import convex_prism_parts, convex_revolution_parts, split_faces
from .convex.convex_polygons import convex_polygon_parts, is_convex_polygon
from .convex.intersect_polyhedra import cut_body, polyhedron_intersection
from .convex.polygon_clipping import clipped_by_convex, inside_convex
from .convex.separating_planes import (
    Separations,
    Surroundings,
    own_box,
    separations,
    separations_after_moves,
    spheres_power,
)
from .cuts.half_spaces import HalfSpaces
from .mesh import Mesh
from .outline import Branches, contour_branches, contour_edges, spatial_hull
from .regions import polygons_of
from .repair.adjacency import (
    BodyRecord,
    FaceRecords,
    body_record,
    common_edge,
    face_barycentres,
    face_constants,
    face_records,
    neighbour_faces,
)
from .repair.mesh_repair import Mending, MeshReport, mended, mesh_report, welded
from .repair.winding import EdgeUses, consistent_winding, edge_uses, is_closed_oriented
from .rotations import (
    axis_frame,
    euler_angles,
    inverse_rotation,
    look_rotation,
    rotated_about_line,
    rotation_about,
    rotation_x,
    rotation_y,
    rotation_z,
)
from .strokes import Strokes
from .vectors import (
    angle,
    angle_line_plane,
    angle_planes,
    from_spherical_coordinates,
    lambert_cosine,
    length,
    normalize,
    point_at_distance,
    point_on_line,
    spherical_coordinates,
    translated,
)

__all__ = [
    "BodyRecord",
    "Box",
    "Branches",
    "Budget",
    "Camera",
    "ClippedLines",
    "CoordinateSystem",
    "EdgeUses",
    "FaceRecords",
    "HalfSpaces",
    "Mending",
    "Mesh",
    "MeshReport",
    "PixelWindow",
    "Polygons",
    "Projection",
    "Separations",
    "Strokes",
    "Surroundings",
    "Window",
    "angle",
    "angle_line_plane",
    "angle_planes",
    "axis_frame",
    "body_record",
    "box",
    "budget_of",
    "clip_and_draw",
    "clip_lines_2d",
    "clip_lines_3d",
    "clip_polygons_2d",
    "clip_polygons_3d",
    "clipped_by_convex",
    "collineate",
    "common_edge",
    "consistent_winding",
    "contour_branches",
    "contour_edges",
    "convex_hull",
    "convex_polygon_parts",
    "convex_prism_parts",
    "convex_revolution_parts",
    "cut_body",
    "cut_polygons",
    "diagonal_field_of_vision_deg",
    "edge_uses",
    "euler_angles",
    "face_barycentres",
    "face_constants",
    "face_records",
    "field_of_vision_deg",
    "focal_length_mm",
    "from_spherical_coordinates",
    "has_convex_outline",
    "hull_mesh",
    "inside_convex",
    "inverse_rotation",
    "is_closed_oriented",
    "is_convex_polygon",
    "lambert_cosine",
    "length",
    "lens_advice",
    "look_rotation",
    "mended",
    "mesh_report",
    "neighbour_faces",
    "normalize",
    "own_box",
    "placed",
    "point_at_distance",
    "point_on_line",
    "polygons_of",
    "polyhedron",
    "polyhedron_intersection",
    "prism",
    "project",
    "projection_of",
    "ragged",
    "region_codes",
    "regular_polygon",
    "revolution",
    "rotated_about_line",
    "rotation_about",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "separations",
    "separations_after_moves",
    "spatial_hull",
    "spheres_power",
    "spherical_coordinates",
    "split_faces",
    "translated",
    "uncollineate",
    "unproject",
    "welded",
]
