from .depth_buffers import DepthCode, depth_buffer
from .illumination import DIRECT_SHARE, FINISHES, lambert, reflected
from .palettes import PALETTE_LIMITS, PALETTE_SIZE, colour_map, palette, shaded_colours
from .screen import raster_system, screen_triangles
from .seen_region import region_in_picture
from .shaded_faces import face_colours, face_middles, face_shades, view_lights
from .shadow_maps import shadow_buffer, square_map, texels_per_unit
from .trapezoids import bounding_trapezoid, line_of_sight

__all__ = [
    "DIRECT_SHARE",
    "FINISHES",
    "PALETTE_LIMITS",
    "PALETTE_SIZE",
    "DepthCode",
    "bounding_trapezoid",
    "colour_map",
    "depth_buffer",
    "face_colours",
    "face_middles",
    "face_shades",
    "lambert",
    "line_of_sight",
    "palette",
    "raster_system",
    "reflected",
    "region_in_picture",
    "screen_triangles",
    "shaded_colours",
    "shadow_buffer",
    "square_map",
    "texels_per_unit",
    "view_lights",
]
