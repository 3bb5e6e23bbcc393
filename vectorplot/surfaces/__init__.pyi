from .algebraic import first_form, gaussian_curvature, implicitized, mean_curvature, parametrised
from .capped_bodies import Capped, Frustum, rod
from .function_surface import surface_of_function
from .graphs import Disc, PolygonRegion, graph, graph_over_disc
from .implicit import implicit_of_function
from .inversion import inverted
from .minimal import helicoid_to_catenoid, minimal_spiral_surface
from .placed_surface import PlacedSurface
from .quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    Paraboloid,
    Quadric,
    Sphere,
    implicit_cylinder,
    implicit_sphere,
)
from .splines import SplineSurface, landscape, nurbs_surface, spline_surface
from .stacked import unit_normals
from .subdivision import SubdivisionSurface
from .surface import Domain
from .swept import helical_surface, revolution_surface, rotoidal_surface, spiral_surface, translation_surface
from .terrains import Terrain, densified_terrain, exaggerated, terrain, terrain_of_points, thinned_terrain
from .tori import ImplicitCyclide, ImplicitTorus, ImplicitTorusByDistance, Torus, dupin_cyclide
from .trimmed import TrimmedSurface

__all__ = [
    "Capped",
    "Cone",
    "Cylinder",
    "Disc",
    "Domain",
    "Ellipsoid",
    "Frustum",
    "HyperbolicParaboloid",
    "Hyperboloid",
    "ImplicitCyclide",
    "ImplicitTorus",
    "ImplicitTorusByDistance",
    "Paraboloid",
    "PlacedSurface",
    "PolygonRegion",
    "Quadric",
    "Sphere",
    "SplineSurface",
    "SubdivisionSurface",
    "Terrain",
    "Torus",
    "TrimmedSurface",
    "densified_terrain",
    "dupin_cyclide",
    "exaggerated",
    "first_form",
    "gaussian_curvature",
    "graph",
    "graph_over_disc",
    "helical_surface",
    "helicoid_to_catenoid",
    "implicit_cylinder",
    "implicit_of_function",
    "implicit_sphere",
    "implicitized",
    "inverted",
    "landscape",
    "mean_curvature",
    "minimal_spiral_surface",
    "nurbs_surface",
    "parametrised",
    "revolution_surface",
    "rod",
    "rotoidal_surface",
    "spiral_surface",
    "spline_surface",
    "surface_of_function",
    "terrain",
    "terrain_of_points",
    "thinned_terrain",
    "translation_surface",
    "unit_normals",
]
