from .depth_buffers import DepthCode, depth_buffer
from .illumination import DIRECT_SHARE, FINISHES, lambert, reflected
from .palettes import PALETTE_LIMITS, PALETTE_SIZE, colour_map, palette, shaded_colours
from .screen import raster_system, screen_triangles
from .seen_region import region_in_picture
from .shaded_faces import face_colours, face_middles, face_shades, view_lights
from .shadow_maps import shadow_buffer
from .trapezoids import line_of_sight

__all__ = [
    "DIRECT_SHARE",
    "FINISHES",
    "PALETTE_LIMITS",
    "PALETTE_SIZE",
    "DepthCode",
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
    "view_lights",
]
