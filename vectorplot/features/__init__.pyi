from .implicit.implicit_curves import (
    implicit_contour,
    implicit_intersection,
    implicit_isophotes,
    implicit_level_lines,
    implicit_parallel_contour,
    implicit_plane_sections,
    implicit_point_light_isophotes,
)
from .implicit.implicit_cusps import implicit_contour_cusps, implicit_parallel_contour_cusps
from .implicit.implicit_mesh import ImplicitMesh, implicit_mesh
from .implicit.implicit_tracing import ImplicitCurves, ImplicitTracing
from .implicit.polygonize import polygonized
from .integral.curvature_fields import AsymptoticDirections, PrincipalDirections
from .integral.face_sites import FaceSites, face_sites
from .integral.geodesics_between import geodesics_between
from .integral.integral_curves import geodesics, integral_curves
from .integral.integration import Accuracy
from .integral.isophote_fields import IsophoteDirections
from .integral.on_meshes.mesh_evenly_spaced import evenly_spaced_mesh_curves
from .integral.on_meshes.mesh_integral_curves import mesh_geodesics, mesh_integral_curves
from .integral.on_meshes.shortest_paths import mesh_distances, mesh_shortest_paths
from .integral.sites import Sites, TangentPlanes
from .integral.spacing.evenly_spaced import evenly_spaced_curves
from .integral.tangent_fields import (
    ConstantElevation,
    ParameterDirection,
    ParameterField,
    SteepestSlope,
    TangentField,
    TurnedField,
    VectorField,
    loxodromes,
)
from .intersections.double_curves import DoubleCurves
from .intersections.implicit_mesh_section import ImplicitMeshSection, implicit_mesh_section
from .intersections.mesh_section import MeshSection, mesh_section
from .intersections.self_intersection import self_intersections
from .intersections.surface_intersection import surface_intersection
from .meshes.edges import Edges, Faces, mesh_edges
from .meshes.mesh_curves import MeshCurves
from .meshes.mesh_intersections import Intersections, face_intersections
from .meshes.mesh_lines import (
    mesh_contour_across_faces,
    mesh_isophote_edges,
    mesh_isophotes,
    mesh_level_lines,
    mesh_parallel_contour_across_faces,
    mesh_plane_sections,
    mesh_point_light_isophote_edges,
    mesh_point_light_isophotes,
)
from .meshes.nearest_on_mesh import MeshPlaces, nearest_on_mesh
from .parametric.conditions import CentralContour, ParallelContour
from .parametric.contour import contour, parallel_contour
from .parametric.curve_tracing import Tracing
from .parametric.cuspidal_edges import singular_lines
from .parametric.cusps import Cusps, contour_cusps, contour_with_cusps
from .parametric.isophotes import isophotes, point_light_isophotes
from .parametric.parameter_lines import borders, parameter_lines, u_lines, v_lines
from .parametric.surface_curves import SurfaceCurves
from .parametric.surface_sections import level_lines, plane_sections, section_by_implicit
from .terrains.label_places import LabelPlaces, label_places
from .terrains.places import places_on_terrain
from .terrains.roads import roads
from .terrains.serpentines import serpentine
from .terrains.water import basins, valley_lines, water_courses, watersheds
from .tessellation import Tessellation, surface_tessellation
from .zeros.grid_triangulation import average_normals, mesh_of_grid, triangulate_surface
from .zeros.zero_manifold import ZeroManifold, zero_manifold_of_f_uv

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
