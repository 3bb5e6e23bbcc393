from .depth_buffers import DepthBuffer, DepthCode, depth_buffer, depth_range
from .illumination import (
    AMBIENT,
    DIRECT_SHARE,
    FINISHES,
    Finish,
    brightness,
    depth_cue,
    distance_factor,
    lambert,
    reflected,
    shades,
)
from .image import Image, png_bytes
from .map_settings import MapSettings
from .palettes import COLOUR_MAP, PALETTE_LIMITS, PALETTE_SIZE, ColourMap, colour_map, palette, shaded_colours, spectrum
from .screen import HalfSpace, ScreenTriangles, raster_size, raster_system, screen_triangles
from .seen_region import SeenRegion, region_in_picture
from .shaded_faces import Shades, face_colours, face_middles, face_shades, view_lights
from .shadow_maps import ShadowBuffer, ShadowMap, SquareMap, recipe_matrix, shadow_buffer, square_map, texels_per_unit
from .trapezoids import Axis, adapted_size, bounding_trapezoid, line_of_sight, trapezoid

__all__ = [
    "AMBIENT",
    "COLOUR_MAP",
    "DIRECT_SHARE",
    "FINISHES",
    "PALETTE_LIMITS",
    "PALETTE_SIZE",
    "Axis",
    "ColourMap",
    "DepthBuffer",
    "DepthCode",
    "Finish",
    "HalfSpace",
    "Image",
    "MapSettings",
    "ScreenTriangles",
    "SeenRegion",
    "Shades",
    "ShadowBuffer",
    "ShadowMap",
    "SquareMap",
    "adapted_size",
    "bounding_trapezoid",
    "brightness",
    "colour_map",
    "depth_buffer",
    "depth_cue",
    "depth_range",
    "distance_factor",
    "face_colours",
    "face_middles",
    "face_shades",
    "lambert",
    "line_of_sight",
    "palette",
    "png_bytes",
    "raster_size",
    "raster_system",
    "recipe_matrix",
    "reflected",
    "region_in_picture",
    "screen_triangles",
    "shaded_colours",
    "shades",
    "shadow_buffer",
    "spectrum",
    "square_map",
    "texels_per_unit",
    "trapezoid",
    "view_lights",
]
