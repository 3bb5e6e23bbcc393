from .depth.depth_buffer import DepthBuffer, depth_buffer, depth_range
from .depth.depth_code import DepthCode
from .light.face_shades import Shades, face_colours, face_middles, face_shades, view_lights
from .light.illumination import (
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
from .light.palettes import (
    COLOUR_MAP,
    PALETTE_LIMITS,
    PALETTE_SIZE,
    ColourMap,
    colour_map,
    palette,
    shaded_colours,
    spectrum,
)
from .raster.image import Image
from .raster.png import png_bytes
from .raster.screen import HalfSpace, ScreenTriangles, raster_size, raster_system, screen_triangles
from .shadows.map_settings import MapSettings
from .shadows.seen_region import SeenRegion, region_in_picture
from .shadows.shadow_buffer import ShadowBuffer, shadow_buffer
from .shadows.shadow_map import ShadowMap, texels_per_unit
from .shadows.trapezoid import Axis, adapted_size, bounding_trapezoid, line_of_sight, trapezoid
from .shadows.trapezoid_matrix import SquareMap, recipe_matrix, square_map

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
