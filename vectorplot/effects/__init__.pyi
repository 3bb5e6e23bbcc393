from .cuts import between_planes
from .cutting.cut_scenes import cut_scene
from .decals.decal_polygons import Decals
from .glass.refraction import angle_of_refraction, inverse_refraction, plate_shift, refracted, seen_in_surface
from .halos import halo
from .shadows.shadow_decals import shadow_decals

__all__ = [
    "Decals",
    "angle_of_refraction",
    "between_planes",
    "cut_scene",
    "halo",
    "inverse_refraction",
    "plate_shift",
    "refracted",
    "seen_in_surface",
    "shadow_decals",
]
