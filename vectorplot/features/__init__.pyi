from .conditions import CentralContour, ParallelContour
from .contours_and_isophotes import (
    contour,
    isophotes,
    level_lines,
    parallel_contour,
    plane_sections,
    point_light_isophotes,
    section_by_implicit,
)
from .curve_tracing import SurfaceCurves, Tracing
from .cusps import Cusps, contour_cusps, contour_with_cusps, singular_lines
from .geodesic_curves import geodesics_between
from .grid_triangulation import average_normals, mesh_of_grid, triangulate_surface
from .implicit_curves import (
    implicit_contour,
    implicit_intersection,
    implicit_isophotes,
    implicit_level_lines,
    implicit_parallel_contour,
    implicit_plane_sections,
    implicit_point_light_isophotes,
)
from .implicit_cusps import implicit_contour_cusps, implicit_parallel_contour_cusps
from .implicit_meshes import ImplicitMesh, implicit_mesh
from .implicit_surfaces import polygonized
from .implicit_tracing import ImplicitCurves, ImplicitTracing
from .intersection_grids import Tessellation, surface_tessellation
from .intersection_tracing import DoubleCurves
from .intersections import self_intersections, surface_intersection
from .mesh_edge_lines import Edges, Faces, mesh_edges
from .mesh_integration import mesh_geodesics, mesh_integral_curves
from .mesh_intersections import Intersections, face_intersections
from .mesh_lines import (
    MeshCurves,
    mesh_contour_across_faces,
    mesh_isophote_edges,
    mesh_isophotes,
    mesh_level_lines,
    mesh_parallel_contour_across_faces,
    mesh_plane_sections,
    mesh_point_light_isophote_edges,
    mesh_point_light_isophotes,
)
from .mesh_sections import ImplicitMeshSection, MeshSection, implicit_mesh_section, mesh_section
from .mesh_streamlines import evenly_spaced_mesh_curves
from .nearest import MeshPlaces, nearest_on_mesh
from .parameter_curves import borders, parameter_lines, u_lines, v_lines
from .shortest_paths import mesh_distances, mesh_shortest_paths
from .streamlines import evenly_spaced_curves
from .surface_integration import Accuracy, geodesics, integral_curves
from .surface_points import FaceSites, Sites, TangentPlanes, face_sites
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
from .terrain_water import LabelPlaces, basins, label_places, places_on_terrain, valley_lines, water_courses, watersheds
from .zero_curves import ZeroManifold, zero_manifold_of_f_uv

__all__ = [
    "Accuracy",
    "AsymptoticDirections",
    "CentralContour",
    "ConstantElevation",
    "Cusps",
    "DoubleCurves",
    "Edges",
    "FaceSites",
    "Faces",
    "ImplicitCurves",
    "ImplicitMesh",
    "ImplicitMeshSection",
    "ImplicitTracing",
    "Intersections",
    "IsophoteDirections",
    "LabelPlaces",
    "MeshCurves",
    "MeshPlaces",
    "MeshSection",
    "ParallelContour",
    "ParameterDirection",
    "ParameterField",
    "PrincipalDirections",
    "Sites",
    "SteepestSlope",
    "SurfaceCurves",
    "TangentField",
    "TangentPlanes",
    "Tessellation",
    "Tracing",
    "TurnedField",
    "VectorField",
    "ZeroManifold",
    "average_normals",
    "basins",
    "borders",
    "contour",
    "contour_cusps",
    "contour_with_cusps",
    "evenly_spaced_curves",
    "evenly_spaced_mesh_curves",
    "face_intersections",
    "face_sites",
    "geodesics",
    "geodesics_between",
    "implicit_contour",
    "implicit_contour_cusps",
    "implicit_intersection",
    "implicit_isophotes",
    "implicit_level_lines",
    "implicit_mesh",
    "implicit_mesh_section",
    "implicit_parallel_contour",
    "implicit_parallel_contour_cusps",
    "implicit_plane_sections",
    "implicit_point_light_isophotes",
    "integral_curves",
    "isophotes",
    "label_places",
    "level_lines",
    "loxodromes",
    "mesh_contour_across_faces",
    "mesh_distances",
    "mesh_edges",
    "mesh_geodesics",
    "mesh_integral_curves",
    "mesh_isophote_edges",
    "mesh_isophotes",
    "mesh_level_lines",
    "mesh_of_grid",
    "mesh_parallel_contour_across_faces",
    "mesh_plane_sections",
    "mesh_point_light_isophote_edges",
    "mesh_point_light_isophotes",
    "mesh_section",
    "mesh_shortest_paths",
    "nearest_on_mesh",
    "parallel_contour",
    "parameter_lines",
    "places_on_terrain",
    "plane_sections",
    "point_light_isophotes",
    "polygonized",
    "roads",
    "section_by_implicit",
    "self_intersections",
    "serpentine",
    "singular_lines",
    "surface_intersection",
    "surface_tessellation",
    "triangulate_surface",
    "u_lines",
    "v_lines",
    "valley_lines",
    "water_courses",
    "watersheds",
    "zero_manifold_of_f_uv",
]
