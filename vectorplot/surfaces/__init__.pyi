from .algebraic import AlgebraicSurface, implicitized
from .curvature import first_form, gaussian_curvature, mean_curvature, second_form
from .families.capped import Capped, Frustum, rod
from .families.cyclide import ImplicitCyclide, dupin_cyclide
from .families.cylinder import Cone, Cylinder
from .families.ellipsoid import Ellipsoid, Sphere
from .families.hyperbolic_paraboloid import HyperbolicParaboloid
from .families.hyperboloid import Hyperboloid, HyperboloidSheet, Paraboloid
from .families.minimal import IsotropicCurve, MinimalSurface, helicoid_to_catenoid, minimal_spiral_surface
from .families.quadric import (
    Quadric,
    implicit_cone,
    implicit_cylinder,
    implicit_ellipsoid,
    implicit_plane,
    implicit_sphere,
)
from .families.swept.helical import helical_surface
from .families.swept.motions import Motion, Rotoid, Screw, SpiralMotion, Translation
from .families.swept.revolution import revolution_surface
from .families.swept.rotoidal import rotoidal_surface
from .families.swept.spiral import spiral_surface
from .families.swept.swept import Swept
from .families.swept.translation import translation_surface
from .families.swept.tube import tube
from .families.torus import ImplicitTorus, ImplicitTorusByDistance, Torus
from .function_surface import FunctionSurface, surface_of_function
from .graphs.graph import Graph, PolarGraph, graph, graph_over_disc
from .graphs.graph_regions import Disc, PolygonRegion, Region
from .graphs.height_grid import densified_grid, grid_of_scattered
from .implicit_function import ImplicitFunction, implicit_of_function
from .inversion import InvertedImplicit, InvertedSurface, inverted
from .normals import unit_normals
from .placed_surface import PlacedImplicit, PlacedSurface
from .splines.landscape import landscape
from .splines.spline_surface import SplineSurface, nurbs_surface, spline_surface
from .surface import Domain, ImplicitSurface, Surface
from .terrains.terrain import (
    Terrain,
    densified_terrain,
    exaggerated,
    terrain,
    terrain_of_points,
    thinned_terrain,
)
from .trims.boxed_implicit import BoxedImplicit
from .trims.cut_implicit import CutImplicit
from .trims.cut_surface import CutSurface
from .trims.trimmed import TrimmedSurface

__all__ = [
    "AlgebraicSurface",
    "BoxedImplicit",
    "Capped",
    "Cone",
    "CutImplicit",
    "CutSurface",
    "Cylinder",
    "Disc",
    "Domain",
    "Ellipsoid",
    "Frustum",
    "FunctionSurface",
    "Graph",
    "HyperbolicParaboloid",
    "Hyperboloid",
    "HyperboloidSheet",
    "ImplicitCyclide",
    "ImplicitFunction",
    "ImplicitSurface",
    "ImplicitTorus",
    "ImplicitTorusByDistance",
    "InvertedImplicit",
    "InvertedSurface",
    "IsotropicCurve",
    "MinimalSurface",
    "Motion",
    "Paraboloid",
    "PlacedImplicit",
    "PlacedSurface",
    "PolarGraph",
    "PolygonRegion",
    "Quadric",
    "Region",
    "Rotoid",
    "Screw",
    "Sphere",
    "SpiralMotion",
    "SplineSurface",
    "Surface",
    "Swept",
    "Terrain",
    "Torus",
    "Translation",
    "TrimmedSurface",
    "densified_grid",
    "densified_terrain",
    "dupin_cyclide",
    "exaggerated",
    "first_form",
    "gaussian_curvature",
    "graph",
    "graph_over_disc",
    "grid_of_scattered",
    "helical_surface",
    "helicoid_to_catenoid",
    "implicit_cone",
    "implicit_cylinder",
    "implicit_ellipsoid",
    "implicit_of_function",
    "implicit_plane",
    "implicit_sphere",
    "implicitized",
    "inverted",
    "landscape",
    "mean_curvature",
    "minimal_spiral_surface",
    "nurbs_surface",
    "revolution_surface",
    "rod",
    "rotoidal_surface",
    "second_form",
    "spiral_surface",
    "spline_surface",
    "surface_of_function",
    "terrain",
    "terrain_of_points",
    "thinned_terrain",
    "translation_surface",
    "tube",
    "unit_normals",
]
