from .contours_and_isophotes import contour, isophotes, plane_sections
from .curve_tracing import Tracing
from .grid_triangulation import mesh_of_grid, triangulate_surface
from .mesh_lines import mesh_level_lines
from .polygonization import polygonized
from .shortest_paths import mesh_shortest_paths
from .surface_integration import Accuracy, geodesics, integral_curves
from .surface_points import Sites, face_sites
from .tangent_fields import (
    AsymptoticDirections,
    ConstantElevation,
    ParameterDirection,
    PrincipalDirections,
    SteepestSlope,
    TurnedField,
    VectorField,
    loxodromes,
)
from .terrain_serpentines import serpentine
from .terrain_water import basins, label_places, water_courses
from .zero_curves import zero_manifold_of_f_uv

__all__ = [
    "Accuracy",
    "AsymptoticDirections",
    "ConstantElevation",
    "ParameterDirection",
    "PrincipalDirections",
    "Sites",
    "SteepestSlope",
    "Tracing",
    "TurnedField",
    "VectorField",
    "basins",
    "contour",
    "face_sites",
    "geodesics",
    "integral_curves",
    "isophotes",
    "label_places",
    "loxodromes",
    "mesh_level_lines",
    "mesh_of_grid",
    "mesh_shortest_paths",
    "plane_sections",
    "polygonized",
    "serpentine",
    "triangulate_surface",
    "water_courses",
    "zero_manifold_of_f_uv",
]
