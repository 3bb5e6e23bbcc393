from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.scene.light import Light
from vectorplot.shading import illumination as il
from vectorplot.shading.illumination import FINISHES, Finish

SIZE = 32


@pytest.mark.capability("G4.5-lambert")
@pytest.mark.capability("G4.5-distance")
@pytest.mark.capability("G4.5-depth")
def light_shares(points, normals, eye, lights, finish):
    """(l, n) the brightness that each light of intensity 1 gives to points with unit normals."""
    return il.brightness(*il.light_cosines(np.asarray(points), np.asarray(normals), eye, lights), finish)


def test_tv23_lambert_distance_and_depth():
    s = il.DIRECT_SHARE * il.lambert(np.cos(0.6), 2.0)
    assert SIZE * s == pytest.approx(17.4381792573014, abs=1e-12)
    s *= il.distance_factor(20.0, 2.0, 5.0)
    assert SIZE * s == pytest.approx(12.1098467064593, abs=1e-12)
    s += il.depth_cue(1.0, -3.0, 8.0)
    assert SIZE * s == pytest.approx(15.3098467064593, abs=1e-12)


@pytest.mark.capability("G8.5-phong")
def test_tv41_reflected_ray_and_highlight():
    n, light, view = np.array([1, 2, 2]) / 3, np.array([0.0, 0, 1]), np.ones(3) / np.sqrt(3)
    r = il.reflected(n, light)
    assert np.allclose(r, (0.444444444444444, 0.888888888888889, -0.111111111111111), rtol=0, atol=1e-14)
    assert r @ view == pytest.approx(0.705650329009543, abs=1e-14)
    finish = Finish.polished(8.0, 0.3)
    assert finish.highlight == 3.0
    assert il.brightness(n @ light, r @ view, finish) == pytest.approx(0.218443258000568, abs=1e-14)


@pytest.mark.capability("G8.5-phong")
def test_no_highlight_where_light_or_eye_is_behind_and_none_beyond_the_palette():
    finish = Finish.polished(64.0, 0.5)
    assert il.brightness(0.5, -1.0, finish) == pytest.approx(0.25)  # an even power must not shine from behind
    assert il.brightness(-0.5, 1.0, finish) == pytest.approx(0.5 * 0.3 * 0.5)
    bright = il.brightness(1.0, 1.0, Finish(1.0, 0.5, 10.0, 64.0, 1.0))
    assert bright > 1.0
    assert il.shades([[bright]], [1.0])[0] == il.DIRECT_SHARE
    assert il.shade_numbers(il.shades([[bright]], [1.0], il.AMBIENT), SIZE)[0] == SIZE - 1


@pytest.mark.capability("G8.5-phong")
def test_measured_weights_are_joined_by_a_spline():
    angles = np.linspace(0, np.pi / 2, 9)
    finish = Finish(1.0, 0.0, 1.0, 1.0, tuple(zip(angles.tolist(), (1 - np.cos(angles)).tolist(), strict=True)))
    between = np.linspace(0.1, 1.4, 50)
    assert np.allclose(finish.weight_at(np.cos(angles[1:-1])), 1 - np.cos(angles[1:-1]), atol=1e-12)
    assert np.allclose(finish.weight_at(np.cos(between)), 1 - np.cos(between), atol=0.01)
    assert np.allclose(il.brightness(np.cos(between), 1.0, finish), finish.weight_at(np.cos(between)))


@pytest.mark.capability("G4.5-material")
def test_larger_exponents_are_darker_between_the_ends():
    cosine = np.linspace(0.05, 0.95, 30)
    series = np.array([il.lambert(cosine, c) for c in (0.5, 0.7, 1.0, 2.0, 4.0, 8.0)])
    assert (np.diff(series, axis=0) < 0).all()
    assert np.all(il.lambert(1.0, 3.0) == 1.0) and np.all(il.lambert(0.0, 0.5) == 0.0)
    # The words for materials have the exponents of their figure.
    exponents = {word: finish.exponent for word, finish in FINISHES.items()}
    assert exponents["normal"] == 1.0 and exponents["metallic"] >= 2.0
    assert 0.5 <= exponents["mat"] < 1.0 and 0.5 <= exponents["wood"] < 1.0


@pytest.mark.capability("G4.5-darkface")
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("lamp", [1.0, -1.0])
def test_dark_faces_of_solids_and_of_hollow_bodies(side, lamp):
    """A face that turns its outer side to z, an eye and a lamp above or below it."""
    normal, to_eye, to_light = (
        np.array([[0.0, 0, 1]]),
        np.array([[0.6, 0, 0.8 * side]]),
        np.array([[0.8, 0, 0.6 * lamp]]),
    )
    solid = (normal * to_light).sum()
    assert il.backlit(solid) == (lamp < 0)
    assert il.lambert(solid) == pytest.approx(0.6 if lamp > 0 else 0.18)
    hollow = (il.facing(normal, to_eye) * to_light).sum()
    assert il.backlit(hollow) == (side != lamp)
    assert il.lambert(hollow) == pytest.approx(0.6 if side == lamp else 0.18)


@pytest.mark.capability("G4.5-distance")
@given(st.floats(-50, 5))
def test_light_fades_with_distance(z):
    factor = il.distance_factor(20.0, z, 5.0)
    assert 0.0 < factor <= 1.0 and factor == pytest.approx((15.0 / (20.0 - z)) ** 2)
    assert il.distance_factor(20.0, 5.0, 5.0) == 1.0


def test_a_point_behind_the_lamp_is_refused():
    with pytest.raises(InputError, match="nearer"):
        il.distance_factor(20.0, 6.0, 5.0)


@pytest.mark.capability("G4.5-multilight")
def test_several_lights_add_up_and_can_be_made_to_fit():
    rng = np.random.default_rng(3)
    lights = [Light((3, 1, 4)), Light((-5, 2, 1), parallel=True), Light((0, -4, 2), intensity=0.3)]
    given = il.intensities(lights)
    assert given == pytest.approx((1 / np.sqrt(3), 1 / np.sqrt(3), 0.3))
    points = rng.uniform(-1, 1, (200, 3))
    normals = rng.normal(size=(200, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    shares = light_shares(points, normals, (0, 0, 9, 1), lights, FINISHES["normal"])
    assert shares.shape == (3, 200)
    # One light at a time, by hand.
    ray = np.array([3.0, 1, 4]) - points
    cosine = (normals * ray).sum(axis=1) / np.linalg.norm(ray, axis=1)
    assert np.allclose(shares[0], np.where(cosine > 0, cosine, -0.3 * cosine), atol=1e-14)
    cosine = normals @ (np.array([-5.0, 2, 1]) / np.sqrt(30))
    assert np.allclose(shares[1], np.where(cosine > 0, cosine, -0.3 * cosine), atol=1e-14)
    factor = il.fitting_factor(shares, given)
    assert (factor * np.asarray(given) @ shares).max() == pytest.approx(1.0)
    assert il.fitting_factor(0.0 * shares, given) == 1.0
    # Without fitting what is too bright stops at the top.
    bright = il.shades(shares, [5.0, 5.0, 5.0], 0.1)
    assert bright.max() == pytest.approx(0.9) and (bright == bright.max()).sum() > 10


@pytest.mark.capability("G4.5-face-shades")
@given(st.lists(st.floats(0, 3), min_size=1, max_size=20), st.floats(0, 0.2))
def test_totals_stay_in_the_palette(shares, cue):
    numbers = il.shade_numbers(il.shades([shares], [1.0], cue), SIZE)
    assert numbers.max() <= SIZE - 1
    exact = np.minimum(np.floor((0.8 * np.minimum(shares, 1.0) + cue) * SIZE + 0.5), SIZE - 1)
    assert np.array_equal(numbers, exact)


def test_four_finishes_shade_a_sphere_differently():
    u, v = np.meshgrid(np.linspace(0, np.pi, 40), np.linspace(0, 2 * np.pi, 80))
    normals = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)], axis=-1).reshape(-1, 3)
    lights = [Light((4, -3, 5))]
    series = {
        word: il.shades(light_shares(normals, normals, (0, -9, 3, 1), lights, FINISHES[word]), [1.0])
        for word in ("plastic", "metallic", "wood", "normal")
    }
    names = list(series)
    for i, one in enumerate(names):
        for other in names[i + 1 :]:
            assert np.abs(series[one] - series[other]).mean() > 0.02, (one, other)
    # A highlight is small and bright: plastic has one, wood has none.
    spot = light_shares(normals, normals, (0, -9, 3, 1), lights, FINISHES["plastic"])[0]
    assert spot.max() > 0.9 and (spot > 0.7).mean() < 0.1
    assert light_shares(normals, normals, (0, -9, 3, 1), lights, FINISHES["wood"])[0].max() <= 0.9


def test_highlights_sit_where_the_mirror_direction_meets_the_eye():
    """On a sphere seen and lit from afar, half way between eye and light."""
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(50_000, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    light, eye = np.array([1.0, 0, 0]), np.array([0.0, 1, 0])
    finish = Finish(1.0, 0.0, 1.0, 200.0, 1.0)
    share = light_shares(normals, normals, (*eye, 0), [Light((1, 0, 0), parallel=True)], finish)[0]
    assert normals[share.argmax()] @ ((light + eye) / np.sqrt(2)) > 0.999


def test_a_point_in_the_lamp_is_not_lit_and_gives_no_nan():
    share = light_shares([(1, 2, 3)], [(0, 0, 1)], (0, 0, 9, 1), [Light((1, 2, 3))], FINISHES["plastic"])
    assert share[0, 0] == 0.0


@pytest.mark.parametrize(
    "make",
    [
        lambda: Finish(exponent=0.0),
        lambda: Finish(diffuse=-1.0),
        lambda: Finish(sharpness=float("nan")),
        lambda: Finish(weight=((0.0, 1.0),)),
        lambda: Finish(weight=((0.0, 1.0), (0.0, 2.0))),
        lambda: Finish.polished(1.0),
        lambda: il.shade_numbers([0.5], 0),
        lambda: il.towards([(0, 0, 0)], (1, 2, float("nan"), 1)),
        lambda: il.intensities([Light((0, 0, 1), intensity=-1.0)]),
    ],
)
def test_bad_numbers_are_refused(make):
    with pytest.raises(InputError):
        make()


def test_glass_keeps_its_colour():
    cosine = np.linspace(0.0, 1.0, 50)
    clear, plain = (il.brightness(cosine, np.zeros(50), FINISHES[word]) for word in ("transparent", "normal"))
    assert (clear >= 0.85 * plain).all()
