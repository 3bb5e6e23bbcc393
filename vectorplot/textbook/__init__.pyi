from .field_steps import euler_curves, runge_kutta_curves
from .intersections import LineCut, line_and_line, line_and_plane, polygons_common_segment, segments
from .orders.graph_orders import graph_order, graph_triangles
from .orders.outline_positions import Position, RelativePosition, in_convex_polygon, relative_position
from .orders.ring_orders import ring_order, sliced_meridian
from .orders.sphere_orders import sphere_order
from .planes import Plane
from .screens.depth_queries import depth_planes, points_visible, visible_line_pixels
from .screens.device import DepthCueing, Device
from .screens.drawn_pixels import with_lines, with_polygons, with_rubber_bands, with_smooth_polygons
from .screens.erasing_faces import Erased, erasing_edges, interleaved
from .screens.framebuffer import Framebuffer, cleared, pixel_colours, swapped_buffers, with_colour, with_pixels
from .viewing.bases import basis_of, basis_of_gaze, frame_from_world, world_from_frame
from .viewing.changed_coordinates import changed_coordinates, with_target_as_origin
from .viewing.frustum import Frustum
from .viewing.homogeneous_points import dehomogenized, homogeneous, transformed
from .viewing.viewing_matrices import (
    ViewVolume,
    camera_matrix,
    pixel_matrix,
    segments_to_pixels,
    viewport,
    window_transform,
)

__all__ = [
    "DepthCueing",
    "Device",
    "Erased",
    "Framebuffer",
    "Frustum",
    "LineCut",
    "Plane",
    "Position",
    "RelativePosition",
    "ViewVolume",
    "basis_of",
    "basis_of_gaze",
    "camera_matrix",
    "changed_coordinates",
    "cleared",
    "dehomogenized",
    "depth_planes",
    "erasing_edges",
    "euler_curves",
    "frame_from_world",
    "graph_order",
    "graph_triangles",
    "homogeneous",
    "in_convex_polygon",
    "interleaved",
    "line_and_line",
    "line_and_plane",
    "pixel_colours",
    "pixel_matrix",
    "points_visible",
    "polygons_common_segment",
    "relative_position",
    "ring_order",
    "runge_kutta_curves",
    "segments",
    "segments_to_pixels",
    "sliced_meridian",
    "sphere_order",
    "swapped_buffers",
    "transformed",
    "viewport",
    "visible_line_pixels",
    "window_transform",
    "with_colour",
    "with_lines",
    "with_pixels",
    "with_polygons",
    "with_rubber_bands",
    "with_smooth_polygons",
    "with_target_as_origin",
    "world_from_frame",
]
