"""What options of render may be."""

from __future__ import annotations

from collections.abc import Sequence

from vectorplot.errors import InputError
from vectorplot.scene.light import Light
from vectorplot.shading.raster.screen import LARGEST_RASTER_PIXELS, LARGEST_SIDE_PIXELS, raster_size
from vectorplot.tolerances.of_numbers import LARGEST_VIEW
from vectorplot.words import check_word

MOST_SAMPLES = 8
"""Along each side of a pixel."""

SAMPLES = 2
"""Along each side of a pixel, unless told otherwise."""


FEWEST_TEXELS, MOST_TEXELS = 256, 4096
"""Along the side of a shadow map, unless told otherwise."""


def usual_samples(size: tuple[int, int]) -> int:
    """Along each side of a pixel where nobody says how many."""
    fine = (size[0] * SAMPLES, size[1] * SAMPLES)
    return SAMPLES if max(fine) <= LARGEST_SIDE_PIXELS and fine[0] * fine[1] <= LARGEST_RASTER_PIXELS else 1


def usual_shadow_size(size: tuple[int, int]) -> int:
    """Texels along the side of a shadow map where nobody says how many: the power of two no less than the longer
    side of the picture, 256 to 4096."""
    needed = 1 << (int(max(size)) - 1).bit_length()
    return min(max(needed, FEWEST_TEXELS), MOST_TEXELS)


def check_render_options(
    size: tuple[int, int], shadows: str, transparency: str, samples: int, crease_angle_deg: float
) -> None:
    """InputError for unknown words, and for numbers out of range."""
    check_word("transparency", transparency, ("blended", "sparse"))
    check_word("shadows", shadows, ("auto", "none", "buffer", "trapezoid", "exact"))
    if not 1 <= samples <= MOST_SAMPLES:
        raise InputError(f"{samples} samples: expected 1 to {MOST_SAMPLES}")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    raster_size(*size)
    raster_size(size[0] * samples, size[1] * samples)


def check_whole(**counts: int) -> None:
    """InputError for counts, by their names, that are no whole numbers."""
    for name, count in counts.items():
        if not float(count).is_integer():
            raise InputError(f"{name} {count:g}: expected a whole number")


def check_lights(lights: Sequence[Light]) -> None:
    """InputError for lights without a direction, or too far away."""
    for number, light in enumerate(lights):
        name = f"light {light.name or number}"
        # NaN is not smaller.
        if not all(abs(coordinate) < LARGEST_VIEW for coordinate in light.position):
            raise InputError(f"{name}: a place or direction of {light.position} is out of range")
        if light.parallel and not any(light.position):
            raise InputError(f"{name}: its rays have no direction")
