from .device import DepthCueing, Device
from .field_steps import euler_curves, runge_kutta_curves
from .framebuffer import Framebuffer, erasing_edges, interleaved, swapped_buffers, with_polygons, with_smooth_polygons
from .intersections import Plane, polygons_common_segment
from .orders import (
    Position,
    cyclic_overlap_report,
    cyclic_overlaps,
    demands,
    graph_order,
    graph_triangles,
    grouped_order,
    in_convex_polygon,
    priorities,
    relative_position,
    ring_order,
    sliced_meridian,
    view_objects,
)
from .polyhedra import body_record, convex_revolution_parts, spatial_hull
from .separating_planes import Surroundings, own_box, separations, spheres_power
from .trapezoid_maps import bounding_trapezoid, square_map, texels_per_unit
from .viewing import Frustum, changed_coordinates

__all__ = [
    "DepthCueing",
    "Device",
    "Framebuffer",
    "Frustum",
    "Plane",
    "Position",
    "Surroundings",
    "body_record",
    "bounding_trapezoid",
    "changed_coordinates",
    "convex_revolution_parts",
    "cyclic_overlap_report",
    "cyclic_overlaps",
    "demands",
    "erasing_edges",
    "euler_curves",
    "graph_order",
    "graph_triangles",
    "grouped_order",
    "in_convex_polygon",
    "interleaved",
    "own_box",
    "polygons_common_segment",
    "priorities",
    "relative_position",
    "ring_order",
    "runge_kutta_curves",
    "separations",
    "sliced_meridian",
    "spatial_hull",
    "spheres_power",
    "square_map",
    "swapped_buffers",
    "texels_per_unit",
    "view_objects",
    "with_polygons",
    "with_smooth_polygons",
]
