from .contours_and_isophotes import contour, isophotes, level_lines, plane_sections
from .curve_tracing import Tracing
from .geodesic_curves import geodesics_between
from .grid_triangulation import mesh_of_grid, triangulate_surface
from .implicit_surfaces import polygonized
from .intersections import self_intersections, surface_intersection
from .mesh_integration import mesh_geodesics
from .mesh_lines import mesh_level_lines, mesh_plane_sections
from .nearest import nearest_on_mesh
from .parameter_curves import borders, parameter_lines
from .shortest_paths import mesh_distances, mesh_shortest_paths
from .streamlines import evenly_spaced_curves
from .surface_integration import Accuracy, geodesics, integral_curves
from .surface_points import Sites, face_sites
from .tangent_fields import (
    AsymptoticDirections,
    ConstantElevation,
    IsophoteDirections,
    ParameterDirection,
    ParameterField,
    PrincipalDirections,
    SteepestSlope,
    TangentField,
    TurnedField,
    VectorField,
    loxodromes,
)
from .terrain_roads import roads
from .terrain_serpentines import serpentine
from .terrain_water import basins, label_places, valley_lines, water_courses, watersheds
from .zero_curves import zero_manifold_of_f_uv

__all__ = [
    "Accuracy",
    "AsymptoticDirections",
    "ConstantElevation",
    "IsophoteDirections",
    "ParameterDirection",
    "ParameterField",
    "PrincipalDirections",
    "Sites",
    "SteepestSlope",
    "TangentField",
    "Tracing",
    "TurnedField",
    "VectorField",
    "basins",
    "borders",
    "contour",
    "evenly_spaced_curves",
    "face_sites",
    "geodesics",
    "geodesics_between",
    "integral_curves",
    "isophotes",
    "label_places",
    "level_lines",
    "loxodromes",
    "mesh_distances",
    "mesh_geodesics",
    "mesh_level_lines",
    "mesh_of_grid",
    "mesh_plane_sections",
    "mesh_shortest_paths",
    "nearest_on_mesh",
    "parameter_lines",
    "plane_sections",
    "polygonized",
    "roads",
    "self_intersections",
    "serpentine",
    "surface_intersection",
    "triangulate_surface",
    "valley_lines",
    "water_courses",
    "watersheds",
    "zero_manifold_of_f_uv",
]
