from .depth_buffers import DepthCode, depth_buffer
from .illumination import DIRECT_SHARE, FINISHES, brightness, depth_cue, lambert, reflected, shades
from .image import Image
from .palettes import PALETTE_LIMITS, PALETTE_SIZE, ColourMap, colour_map, palette, shaded_colours
from .screen import ScreenTriangles, raster_system, screen_triangles
from .seen_region import region_in_picture
from .shaded_faces import face_colours, face_middles, face_shades, view_lights
from .shadow_maps import recipe_matrix, shadow_buffer, square_map, texels_per_unit
from .trapezoids import adapted_size, bounding_trapezoid, line_of_sight, trapezoid

__all__ = [
    "DIRECT_SHARE",
    "FINISHES",
    "PALETTE_LIMITS",
    "PALETTE_SIZE",
    "ColourMap",
    "DepthCode",
    "Image",
    "ScreenTriangles",
    "adapted_size",
    "bounding_trapezoid",
    "brightness",
    "colour_map",
    "depth_buffer",
    "depth_cue",
    "face_colours",
    "face_middles",
    "face_shades",
    "lambert",
    "line_of_sight",
    "palette",
    "raster_system",
    "recipe_matrix",
    "reflected",
    "region_in_picture",
    "screen_triangles",
    "shaded_colours",
    "shades",
    "shadow_buffer",
    "square_map",
    "texels_per_unit",
    "trapezoid",
    "view_lights",
]
