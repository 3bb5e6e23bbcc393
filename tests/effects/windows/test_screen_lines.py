import numpy as np
import pytest
import shapely

from vectorplot.effects.windows import screen_door, sparseness
from vectorplot.errors import InputError
from vectorplot.io.scene_language import parse_scene
from vectorplot.scene.material import Material
from vectorplot.shading.screen import every_nth

ELL = np.array([(0, 0), (9, 0), (9, 3), (3, 3), (3, 9), (0, 9)], dtype=float).T
DISC = 5.0 * np.stack([np.cos(np.linspace(0, 6.2, 60)), np.sin(np.linspace(0, 6.2, 60))]) + 20.0


@pytest.mark.capability("G6.6-screen-door")
@pytest.mark.parametrize("every", [1, 2, 3, 4])
@pytest.mark.parametrize("angle_deg", [0.0, 45.0, 117.0])
def test_every_nth_line_covers_an_nth_of_the_area(every: int, angle_deg: float) -> None:
    pitch = 0.05
    points, offsets = np.concatenate([ELL, DISC], axis=1), np.array([0, 6, 66])
    strokes = screen_door(points, offsets, pitch, every, angle_deg)
    length = np.hypot(*(strokes.end - strokes.start))
    for number, polygon in enumerate((shapely.polygons(ELL.T), shapely.polygons(DISC.T))):
        mine = strokes.polygon == number
        assert np.isclose(length[mine].sum() * pitch * every, polygon.area, rtol=0.02)
        ends = np.stack([strokes.start[:, mine], strokes.end[:, mine]], axis=-1)
        lines = shapely.linestrings(ends.transpose(1, 2, 0))
        assert shapely.contains(polygon.buffer(1e-9), lines).all()


def test_strokes_are_parallel_share_one_set_of_lines_and_are_sorted() -> None:
    points, offsets = np.concatenate([ELL, ELL - np.array([[0.0], [9.0]])], axis=1), np.array([0, 6, 12])
    strokes = screen_door(points, offsets, 0.4, np.array([2, 4]), 30.0)
    across = np.array([-0.5, np.sqrt(0.75)])
    height = across @ strokes.start
    assert np.allclose(height, across @ strokes.end, atol=1e-12)
    for number, distance in ((0, 0.8), (1, 1.6)):
        line = height[strokes.polygon == number] / distance - 0.5
        assert np.allclose(line, np.rint(line), atol=1e-9)
    assert (np.diff(strokes.polygon) >= 0).all()


def test_clear_polygons_and_those_between_lines_get_no_strokes() -> None:
    offsets = np.array([0, 6])
    assert len(screen_door(ELL, offsets, 0.1, 0)) == 0
    assert len(screen_door(1e-3 * ELL, offsets, 10.0, 1)) == 0
    assert len(screen_door(np.zeros((2, 0)), np.array([0]), 1.0, 2)) == 0


@pytest.mark.hard(68)
@pytest.mark.parametrize("pitch", [0.0, -1.0, np.nan, np.inf, 1e-9])
def test_lines_that_fill_nothing_or_too_much(pitch: float) -> None:
    with pytest.raises(InputError):
        screen_door(ELL, np.array([0, 6]), pitch, 2)


def test_lines_through_corners_enter_and_leave() -> None:
    # Heights of the corners are lines of the screen: none may lose its partner.
    diamond = np.array([(0, -1.5), (2, 0.5), (0, 2.5), (-2, 0.5)], dtype=float).T
    strokes = screen_door(diamond, np.array([0, 4]), 1.0, 1, 0.0)
    assert sorted(strokes.start[1].tolist()) == [-0.5, 0.5, 1.5]
    assert np.allclose(np.sort(strokes.end[0] - strokes.start[0]), [2.0, 2.0, 4.0])


@pytest.mark.capability("G6.6-screen-door")
@pytest.mark.parametrize("every", [1, 2, 3, 4])
def test_every_nth_pixel_is_set_evenly(every: int) -> None:
    pixels = every_nth(np.arange(120)[:, None], np.arange(240), every)
    assert pixels.mean() == 1.0 / every
    assert (pixels.sum(axis=0) == 120 // every).all() or every == 4
    if every > 1:
        assert not (pixels[:, 1:] & pixels[:, :-1]).any() and not (pixels[1:] & pixels[:-1]).any()


def test_how_sparse_opacities_are() -> None:
    assert sparseness([1.0, 0.9, 0.5, 0.34, 0.25, 0.01, 0.0]).tolist() == [1, 2, 2, 3, 4, 4, 0]


def test_opacities_out_of_range_are_refused() -> None:
    for wrong in (-0.1, 1.5, np.nan):
        with pytest.raises(InputError, match="transparent: an opacity of"):
            Material("transparent", wrong)


def test_scene_files_name_transparent_things() -> None:
    scene = parse_scene("PANE transparent opacity 0.25 refraction 1.5 box 1 1 1\nWALL box 1 1 1")
    assert [item.material.opacity for item in scene.items] == [0.25, 1.0]
    assert [item.hides for item in scene.items] == [False, True]
