from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.shading import palettes
from vectorplot.shading.palettes import PALETTE_LIMITS, PLAIN, colour_map, palette, palette_number, ramp, spectrum
from vectorplot.textbook.device import Device
from vectorplot.words import COLOURS, PALETTES

limit = st.tuples(*[st.floats(0, 1)] * 3)


@pytest.mark.capability("G4.3-palettes")
def test_tv22_shade_17_of_magenta():
    assert ramp(*PALETTE_LIMITS["magenta"])[17] == pytest.approx(
        (0.593548387096774, 0.154838709677419, 0.593548387096774), abs=1e-14
    )


@pytest.mark.capability("G4.3-palettes")
@pytest.mark.parametrize("name", PALETTE_LIMITS)
def test_first_and_last_shade_are_the_limits(name):
    shades = ramp(*PALETTE_LIMITS[name])
    assert len(shades) == 32
    assert np.allclose(shades[[0, -1]], PALETTE_LIMITS[name], rtol=0, atol=1e-15)
    assert np.allclose(np.diff(shades, n=2, axis=0), 0, atol=1e-15)
    assert np.array_equal(palette(name)[[0, -1]], np.floor(255 * np.array(PALETTE_LIMITS[name]) + 0.5))


@pytest.mark.capability("G4.3-palettes")
def test_eight_palettes_fill_a_colour_map():
    assert tuple(PALETTE_LIMITS) == PALETTES and len(colour_map([]).entries) == 256 == 8 * colour_map([]).size
    # The book's table, lower and upper limit.
    table = {
        "gray": (0, 0, 0, 1, 1, 1),
        "green": (0, 0.3, 0, 0.8, 1, 0.8),
        "yellow": (0.5, 0.3, 0, 1, 1, 0.5),
        "blue": (0, 0.25, 0.45, 0.7, 0.7, 1),
        "pink": (0.5, 0, 0.25, 1, 0.85, 0.8),
        "cyan": (0, 0.25, 0.25, 0.5, 1, 1),
        "magenta": (0.1, 0.1, 0.1, 1, 0.2, 1),
        "orange": (0.5, 0.15, 0, 1, 0.6, 0.4),
    }
    assert {name: tuple(np.ravel(limits)) for name, limits in PALETTE_LIMITS.items()} == table


@pytest.mark.capability("G4.3-spectrum")
@given(limit, limit, st.integers(2, 256), st.integers(2, 300))
def test_no_two_neighbours_of_a_spectrum_are_equal_and_all_are_in_range(lower, upper, count, levels):
    shades = spectrum(lower, upper, count, levels)
    assert shades.shape == (count, 3) and shades.min() >= 0 and shades.max() <= levels - 1
    assert (shades[1:] != shades[:-1]).any(axis=1).all()
    exact = ramp(lower, upper, count) * (levels - 1)
    assert np.abs(shades - exact).max() <= 1.5 + 1e-9


@pytest.mark.capability("G4.3-spectrum")
def test_a_spectrum_for_a_device_of_few_levels():
    gray = spectrum((0, 0, 0), (1, 1, 1), 32, 16)
    assert np.abs(gray - 15 * np.linspace(0, 1, 32)[:, None]).max() <= 1.5
    assert spectrum((0, 0, 0), (1, 1, 1), 32, 256)[[0, 31]].tolist() == [[0] * 3, [255] * 3]
    white = spectrum((1, 1, 1), (1, 1, 1), 5, 8)
    assert (white[1:] != white[:-1]).any(axis=1).all() and white.max() == 7


@pytest.mark.capability("G4.3-subpalettes")
@pytest.mark.parametrize("count", [2, 31, 32, 256])
@pytest.mark.parametrize("name", PALETTE_LIMITS)
def test_halves_lie_in_their_parent(name, count):
    parent, light, dark = (palette(word + name, count) for word in ("", "light", "dark"))
    assert np.array_equal(light[-1], parent[-1]) and np.array_equal(dark[0], parent[0])
    for i in range(count):
        assert np.array_equal(dark[i], parent[i // 2]) and np.array_equal(light[i], parent[(count + i) // 2])


@pytest.mark.capability("G4.3-lookup")
@pytest.mark.capability("G3.L-light-dark")
def test_numbers_of_palettes():
    assert [palette_number(name) for name in PALETTE_LIMITS] == list(range(8))
    assert [palette_number("light" + name) for name in PALETTE_LIMITS] == list(range(8, 16))
    assert [palette_number("dark" + name) for name in PALETTE_LIMITS] == list(range(16, 24))


@pytest.mark.capability("G4.3-lookup")
def test_the_fewer_palettes_are_used_the_more_shades_they_have():
    whole = colour_map(["gray"])
    assert whole.size == 256 and whole.parents == ("gray",)
    some = colour_map(["darkblue", "cyan", "lightblue", "cyan"], colours=256, offset=16)
    assert some.parents == ("blue", "cyan") and some.size == 120
    assert not some.entries[:16].any()
    for name in ("blue", "lightblue", "darkblue", "cyan"):
        shade = np.linspace(0, 1, 50)
        expected = palette(name, 120)[palettes.shade_numbers(shade, 120)]
        assert np.array_equal(some.entries[some.entry(name, shade)], expected)
    with pytest.raises(InputError, match="not in the colour map"):
        some.entry("gray", 0.5)


@pytest.mark.capability("G4.3-background")
def test_the_background_of_the_screen_is_the_darkest_gray_behind_all_ramps():
    """A picture of all ramps on a device: its colour table, entry by entry, and the background where nothing is."""
    names = [f"{half}{name}" for half in ("", "light", "dark") for name in palettes.PALETTE_LIMITS]
    table = colour_map(names)
    device = Device().opened(34, 26)
    for number, rgb in enumerate(table.entries.tolist()):
        device = device.with_rgb(number, *rgb)
    device = device.cleared(int(table.entry("gray", 0.0)))
    for row, name in enumerate(names):
        for column, shade in enumerate(np.linspace(0.0, 1.0, 32)):
            device = device.with_colour(int(table.entry(name, shade))).with_pixel(column + 1, row + 1)
    picture = device.swapped().frame.picture()
    for row, name in enumerate(names):
        assert np.array_equal(picture[row + 1, 1:33], palette(name)[palettes.shade_numbers(np.linspace(0, 1, 32), 32)])
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert (border == table.background).all() and table.background == (0, 0, 0)


@pytest.mark.capability("G4.3-background")
def test_the_background_is_the_darkest_gray():
    assert colour_map(["blue"]).background == (0, 0, 0) == tuple(palette("gray")[0].tolist())


def test_every_word_of_the_scene_language_is_a_palette():
    for name in COLOURS:
        shades = palette(name)
        assert shades.shape == (32, 3) and shades.dtype == np.uint8
        brightness = shades.astype(int).sum(axis=1)
        assert (np.diff(brightness) >= 0).all() and (name == "black" or brightness[-1] > brightness[0])


def test_plain_colours_are_their_own_brightest_shade():
    assert palette("red")[-1].tolist() == [255, 0, 0] and palette("#ff8000")[-1].tolist() == [255, 128, 0]
    assert palette("#FF8000")[0].tolist() == [51, 26, 0]
    assert set(PLAIN) == {"white", "black", "red"}


def test_colours_of_many_faces_at_once():
    names, which, shade = ["gray", "darkblue", "#102030"], np.array([2, 0, 1, 1]), np.array([1.0, 0.0, 0.5, 2.0])
    found = palettes.shaded_colours(names, which, shade)
    assert found.tolist() == [
        [16, 32, 48],
        [0, 0, 0],
        palette("darkblue")[16].tolist(),
        palette("darkblue")[31].tolist(),
    ]
    assert palettes.shaded_colours([], np.zeros(0, dtype=int), np.zeros(0)).shape == (0, 3)


@pytest.mark.capability("G8.5-coloured-light")
def test_a_coloured_light_changes_the_bright_end():
    body = ramp(*PALETTE_LIMITS["blue"])
    mixed = palettes.mixed(body, (1.0, 0.9, 0.2), 20)
    assert np.array_equal(mixed[:20], body[:20]) and np.allclose(mixed[-1], (1.0, 0.9, 0.2))


@pytest.mark.parametrize(
    "make",
    [
        lambda: palette("blu"),
        lambda: palette("lightwhite"),
        lambda: palette("#12345"),
        lambda: palette("gray", 1),
        lambda: palette("gray", 10**9),
        lambda: spectrum((0, 0, 0), (1, 1, float("nan"))),
        lambda: spectrum((0, 0, 0), (1, 1, 2)),
        lambda: spectrum((0, 0, 0), (1, 1, 1), levels=1),
        lambda: colour_map(["gray"], colours=1),
        lambda: colour_map(["gray"], offset=-1),
        lambda: palettes.mixed(ramp((0, 0, 0), (1, 1, 1)), (1, 1, 1), 32),
    ],
)
def test_what_is_no_palette_is_refused(make):
    with pytest.raises(InputError):
        make()
