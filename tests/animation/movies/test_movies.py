"""Movies as files of polygons: packing, layout byte for byte, pruning, freezing, reading back, hostile files."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from support.paths import DATA

import vectorplot as vp
from vectorplot.animation.movies import (
    Movie,
    MovieFrame,
    MoviePalette,
    coloured_polygons,
    decoded,
    encoded,
    frame_drawings,
    movie_of,
    packed,
    pruned,
    read_movie,
    unpacked,
)
from vectorplot.backends.cairo import drawing_pixels
from vectorplot.backends.raster import painted
from vectorplot.drawing import Fills
from vectorplot.geometry import box

GRAY = MoviePalette(0, (0, 0, 0), (255, 255, 255))
RED = MoviePalette(7, (50, 0, 0), (255, 40, 30))


def frame(*polygons):
    """A frame of polygons: points, palette, shades (one, or one for each corner)."""
    points = np.concatenate([np.array(one[0]) for one in polygons])
    sizes = [len(one[0]) for one in polygons]
    shades = np.concatenate([np.broadcast_to(one[2], len(one[0])) for one in polygons])
    return MovieFrame(points, np.cumsum([0, *sizes]), np.array([one[1] for one in polygons]), shades)


def square(x, y, side, palette=0, shade=100):
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)], palette, shade


PAGE = square(0, 0, 4095, 0, 255)


@pytest.mark.capability("G10.1-pack")
def test_test_values_52_and_53():
    first = [0xABC, 0xDEF, 0x123, 0x456, 0x789, 0xFED, 0xCBA, 0x987]
    assert packed(first).hex(" ", 4) == "abcdef12 3456789f edcba987"
    second = [0, 4095, 1, 2048, 255, 4080, 7, 1234]
    assert packed(second).hex(" ") == "00 0f ff 00 18 00 0f ff f0 00 74 d2"
    assert unpacked(packed(first)).tolist() == first and unpacked(packed(second)).tolist() == second


@pytest.mark.capability("G10.1-pack")
def test_every_number_comes_back_from_every_place():
    every = np.arange(4096)
    for place in range(8):
        numbers = np.concatenate([np.full(place, 4095), every])
        back = unpacked(packed(numbers))
        assert np.array_equal(back[: len(numbers)], numbers) and not back[len(numbers) :].any()
        assert len(packed(numbers)) == 12 * -(-len(numbers) // 8)
    assert packed([]) == b"" and not len(unpacked(b""))
    for wrong in ([4096], [-1]):
        with pytest.raises(vp.InputError, match="0 to 4095"):
            packed(wrong)


@pytest.mark.capability("G10.1-record")
def test_files_are_byte_for_byte_as_they_are_laid_out():
    shown = frame(square(1, 2, 3, 7, 9), ([(0xABC, 0xDEF), (0x123, 0x456)], 0, 200))
    first, second = encoded(Movie((GRAY, RED), (shown, None)))
    assert list(first) == [
        *(255, 0),
        *(0, 0, 0, 0, 255, 255, 255),
        *(7, 50, 0, 0, 255, 40, 30),
        *(254, 1, 4, 7, 9, 2, 0, 200),
        *(254, 0),
        255,
    ]
    assert second == packed([255, 1, 2, 4, 2, 4, 5, 1, 5, 0xABC, 0xDEF, 0x123, 0x456, 0, 0, 0])
    smooth = frame(([(0, 0), (9, 0), (0, 9)], 0, [1, 2, 3]), ([(0, 0), (9, 9)], 0, 200))
    assert list(encoded(Movie((GRAY,), (smooth,), smooth=True))[0][9:]) == [254, 1, 3, 0, 1, 2, 3, 2, 0, 200, 255]


@pytest.mark.capability("G10.1-size")
def test_a_quadrilateral_takes_fifteen_bytes_and_a_shaded_one_eighteen():
    squares = [square(5 * k, 5 * k, 40) for k in range(300)]
    plain = sum(map(len, encoded(Movie((GRAY,), (frame(*squares),)))))
    shaded = sum(map(len, encoded(Movie((GRAY,), (frame(*squares),), smooth=True))))
    assert plain == 300 * 15 + 24 and shaded == 300 * 18 + 24


@st.composite
def movies(draw):
    smooth = draw(st.booleans())
    kinds = draw(st.lists(st.integers(0, 253), min_size=1, max_size=4, unique=True))
    bytes3 = st.tuples(*[st.integers(0, 255)] * 3)
    palettes = tuple(MoviePalette(index, draw(bytes3), draw(bytes3)) for index in kinds)
    frames = []
    for _ in range(draw(st.integers(0, 4))):
        sizes = draw(st.lists(st.integers(2, 6), max_size=5))
        if draw(st.booleans()):
            frames.append(None)
            continue
        count = sum(sizes)
        points = draw(arrays.arrays(np.intp, (count, 2), elements=st.integers(0, 4095)))
        shades = draw(arrays.arrays(np.intp, count, elements=st.integers(0, 255)))
        first = np.cumsum([0, *sizes])[:-1]
        alike = np.repeat(np.array(sizes, dtype=np.intp) == 2, sizes) | (not smooth)
        shades = np.where(alike, np.repeat(shades[first] if count else shades, sizes), shades)
        palette = np.array([draw(st.sampled_from(kinds)) for _ in sizes], dtype=np.intp)
        frames.append(MovieFrame(points, np.cumsum([0, *sizes]), palette, shades))
    return Movie(palettes, tuple(frames), smooth)


@pytest.mark.slow
@pytest.mark.capability("G10.2-replay")
@given(movie=movies())
def test_what_is_encoded_is_decoded(movie):
    assert decoded(*encoded(movie)) == movie


@given(movie=movies(), data=st.data())
def test_hostile_files_are_refused_in_one_line(movie, data):
    first, second = map(bytearray, encoded(movie))
    which = data.draw(st.sampled_from([first, second]))
    if data.draw(st.booleans()):
        del which[data.draw(st.integers(0, len(which) - 1)) :]
    else:
        which[data.draw(st.integers(0, len(which) - 1))] = data.draw(st.integers(0, 255))
    try:
        decoded(bytes(first), bytes(second), "a.vd1", "a.vd2")
    except vp.InputError as error:
        assert str(error).startswith(("a.vd1: ", "a.vd2: ")) and "\n" not in str(error)


@pytest.mark.capability("G10.2-replay")
def test_every_truncation_is_told():
    first, second = encoded(Movie((GRAY,), (frame(PAGE, square(5, 5, 60)), None)))
    for end in range(len(first)):
        with pytest.raises(vp.InputError, match=r"a\.vd1: byte \d+: the movie breaks off here"):
            decoded(first[:end], second, "a.vd1", "a.vd2")
    for end in range(len(second)):
        with pytest.raises(vp.InputError, match=r"a\.vd2: "):
            decoded(first, second[:end], "a.vd1", "a.vd2")


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({0: 7}, "byte 0: expected 255, got 7: this is no movie"),
        ({1: 2}, "byte 1: expected 0 or 1 for shades, got 2"),
        ({9: 0}, "byte 9: a second palette 0"),
        ({10: 9}, "byte 10: expected 0 or 1 for a frame that is frozen or new, got 9"),
        ({10: 0}, "byte 11: a frozen frame has no polygons, got 4"),
        ({11: 1}, "byte 11: a polygon of 1 corners"),
        ({12: 3}, "byte 12: there is no palette 3"),
        ({11: 9}, "a.vd2: it ends before the frame at byte 14 of a.vd1"),
    ],
    ids=range(8),
)
def test_what_is_wrong_is_told_with_its_byte(change, cause):
    first, second = map(bytearray, encoded(Movie((GRAY,), (frame(PAGE),))))
    for at, value in change.items():
        first[at] = value
    with pytest.raises(vp.InputError) as error:
        decoded(bytes(first), bytes(second), "a.vd1", "a.vd2")
    assert cause in str(error.value)


@pytest.mark.capability("G10.2-replay")
def test_a_replay_has_palettes_of_256_shades_and_frozen_frames():
    shades = RED.shades
    assert shades.shape == (256, 3) and shades[0].tolist() == [50, 0, 0] and shades[255].tolist() == [255, 40, 30]
    movie = Movie((GRAY, RED), (None, frame(PAGE, square(100, 100, 50, 7, 255)), None))
    blank, new, frozen = frame_drawings(movie, 100.0)
    assert not len(blank.layers[0].fills[0]) and frozen is new
    fills = new.layers[0].fills[0]
    assert (new.width_mm, new.height_mm) == (100.0, 100.0) and fills.colours[-1].tolist() == [255, 40, 30]
    assert np.allclose(fills.points[4], 100 * 100 / 4095)


def turning(frames=3, **given):
    """Dice that turn, painted."""
    dice = [vp.Item(f"die {k}", box((1, 1, 1)).moved(1.6 * k, 0, 0), "blue") for k in range(3)]
    scene = vp.Scene(tuple(dice), camera=vp.Camera((9, -12, 7), (1.5, 0, 0)), lights=(vp.Light((2, -9, 9)),))
    moving = vp.Animation(lambda time: scene.turned("z", 50 * time), frames=frames, mode="shadows")
    return vp.animate(moving, page="120x80", **given)


@pytest.mark.capability("G10.1-buffer")
def test_polygons_are_clipped_scaled_and_tiny_ones_dropped():
    corners = np.array([(-50.0, 10.0), (60.0, 10.0), (60.0, 70.0), (5.0, 5.0), (5.05, 5.0), (5.0, 5.05)])
    fills = Fills.flat(corners, np.array([0, 3, 6]), np.array([(255, 0, 0), (0, 0, 255)], dtype=np.uint8))
    found = coloured_polygons(vp.Drawing(120.0, 80.0, (vp.Layer("fills", vp.Pen(), (fills,)),)))
    assert np.diff(found.offsets).tolist() == [4, 4]
    assert found.points[:4].max(axis=0).tolist() == [4095, 2730] and found.points[4:].min(axis=0)[0] == 0.0
    assert np.abs(found.points[4:].max(axis=0) - np.array([60, 70]) * 4095 / 120).max() <= 0.5
    lines = vp.draw(vp.Item("die", box((1, 1, 1))), page="120x80", hidden="dashed")
    every = coloured_polygons(lines)
    assert set(np.diff(every.offsets)[1:].tolist()) == {2} and (every.points >= 0).all()


@pytest.mark.capability("G10.1-freeze")
def test_a_frame_that_comes_again_is_one_flag():
    drawing = turning().picture(0)
    once, thrice = movie_of([drawing]), movie_of([drawing] * 3)
    assert thrice.frames[1:] == (None, None)
    (one, places), (three, same) = encoded(once), encoded(thrice)
    assert three == one[:-1] + bytes([254, 0, 254, 0, 255]) and places == same


@pytest.mark.capability("G10.1-prune")
def test_polygons_are_left_out_where_nobody_sees_them():
    none = np.full(9, -1)
    big, small = square(500, 500, 2000, 0, 50), square(1000, 1000, 300, 0, 90)
    assert pruned(frame(PAGE, small, big), none[:3]).tolist() == [True, False, True]
    assert pruned(frame(PAGE, big, small), none[:3]).tolist() == [True, True, True]
    # Two halves of an item cover together what neither does alone.
    left, right = square(500, 500, 1000, 0, 50), square(1500, 500, 1000, 0, 60)
    middle = square(1400, 700, 200, 0, 90)
    assert pruned(frame(PAGE, middle, left, right), np.array([-1, 0, 1, 1])).tolist() == [True, False, True, True]
    assert pruned(frame(PAGE, middle, left, right), none[:4]).all()
    # The same colour once more: but not over something that lies between.
    again = square(1000, 1000, 300, 0, 50)
    between = square(900, 900, 150, 0, 90)
    assert pruned(frame(PAGE, big, again), none[:3]).tolist() == [True, True, False]
    assert pruned(frame(PAGE, big, between, again), none[:4]).all()
    line = ([(900, 900), (1200, 1200)], 0, 90)
    assert pruned(frame(PAGE, big, line, again), none[:4]).all()


@pytest.mark.slow
@pytest.mark.capability("G10.1-prune")
def test_a_pruned_movie_shows_the_same_pixels_and_is_smaller(monkeypatch):
    drawing = vp.paint(DATA / "town.scene", vp.Camera((62, -88, 18), fov_deg=30), page="160x110")
    less = movie_of([drawing])
    monkeypatch.setattr("vectorplot.animation.movies.pruned", lambda frame, item: np.ones(len(frame), bool))
    more = movie_of([drawing])
    assert sum(map(len, encoded(less))) < 0.8 * sum(map(len, encoded(more)))
    (shown,), (whole,) = frame_drawings(less), frame_drawings(more)
    blank = np.zeros((330, 480, 3), dtype=np.uint8)
    assert np.array_equal(painted(blank, shown), painted(blank, whole))
    # Neighbours of one colour are drawn as one where nothing stands between them: their blended seams differ a bit.
    off = np.abs(drawing_pixels(shown).astype(int) - drawing_pixels(whole)).max(axis=2)
    assert off.max() < 48 and (off > 0).mean() < 0.001


def test_colours_of_pictures_come_back():
    film = turning()
    movie = movie_of([film.picture(0)])
    (shown,) = frame_drawings(movie, 120.0)
    off = drawing_pixels(shown).astype(int) - drawing_pixels(film.picture(0))
    assert (np.abs(off).max(axis=2) > 3).mean() < 0.01


def test_many_colours_and_many_corners():
    turn = np.linspace(0.0, 2.0 * np.pi, 601)[:-1]
    disc = 40.0 + 30.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    random = np.random.default_rng(1)
    dots = (random.uniform(0, 75, (400, 1, 2)) + np.array([(0, 0), (4, 0), (0, 4)])).reshape(-1, 2)
    colours = random.integers(0, 256, (401, 3)).astype(np.uint8)
    offsets = np.cumsum([0, 600, *[3] * 400])
    fills = Fills.flat(np.concatenate([disc, dots]), offsets, colours)
    movie = movie_of([vp.Drawing(80.0, 80.0, (vp.Layer("fills", vp.Pen(), (fills,)),))])
    assert decoded(*encoded(movie)) == movie and len(movie.palettes) <= 254
    assert movie.frames[0].sizes.max() <= 253


@pytest.mark.capability("G10.1-record")
@pytest.mark.capability("G10.1-size")
def test_a_film_of_250_frames_of_300_polygons_is_under_1200_kilobytes(tmp_path):
    random = np.random.default_rng(5)
    corners = random.uniform(10.0, 80.0, (300, 1, 2)) + np.array([(0, 0), (9, 1), (8, 7), (1, 9)])
    shades = (np.linspace(0.2, 1.0, 300)[:, None] * (255, 120, 60)).astype(np.uint8)
    fills = Fills.flat(corners.reshape(-1, 2), np.arange(0, 1201, 4), shades)
    drawing = vp.Drawing(120.0, 120.0, (vp.Layer("fills", vp.Pen(), (fills,)),))
    vp.save_frames([drawing, drawing], tmp_path / "film.vd1")
    short = read_movie(tmp_path / "film.vd2")
    first = short.frames[0]
    assert short.frames[1] is None and len(first) > 250
    # The same polygons, and as many more as were left out, on their way through the page.
    whole = first.take(np.arange(301) % len(first))
    moved = [
        MovieFrame(
            np.minimum(whole.points + step, 4095), *(getattr(whole, name) for name in ("offsets", "palette", "shades"))
        )
        for step in range(250)
    ]
    movie = Movie(short.palettes, tuple(moved))
    content = encoded(movie)
    assert 1_100_000 < sum(map(len, content)) < 1_200_000
    assert decoded(*content) == movie
