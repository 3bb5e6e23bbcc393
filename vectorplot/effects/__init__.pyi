from .cuts import between_planes, cut_scene
from .decals import Decals
from .halos import halo
from .refraction import angle_of_refraction, inverse_refraction, plate_shift, refracted, seen_in_surface
from .shadows import shadow_decals

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
