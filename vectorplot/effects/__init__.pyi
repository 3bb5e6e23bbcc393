from .cuts import cut_scene
from .refraction import angle_of_refraction, inverse_refraction, plate_shift, refracted, seen_in_surface
from .shadows import shadow_decals

__all__ = [
    "angle_of_refraction",
    "cut_scene",
    "inverse_refraction",
    "plate_shift",
    "refracted",
    "seen_in_surface",
    "shadow_decals",
]
