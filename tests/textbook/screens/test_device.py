"""The device's handful of primitives: what pixels they set, on both pages, and as the end of any clipping."""

from dataclasses import dataclass
from functools import reduce

import numpy as np
import pytest
from support.backend_samples import grey_of_pgm, run

import vectorplot as vp
from vectorplot.backends.page import Areas, page_marks
from vectorplot.errors import InputError
from vectorplot.geometry import clipping as clipped_lines
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.clipping import Box, Window
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.shading.illumination import LEAST, depth_shades
from vectorplot.testing.shapes import box
from vectorplot.textbook import framebuffer as drawn_pixels
from vectorplot.textbook.device import DepthCueing, Device
from vectorplot.textbook.viewing import clip_and_draw, clip_lines_3d

COLUMNS, ROWS = 60, 45


def drawn_on(device: Device) -> set[tuple[int, int]]:
    """Column and row of every pixel of the drawn page that is not of colour 0."""
    frame = device.frame
    row, column = np.nonzero(frame.pages[frame.drawn, ..., 0])
    return set(zip(column.tolist(), row.tolist(), strict=True))


def blank() -> Device:
    return Device().opened(COLUMNS, ROWS).with_colour(7)


def line(device: Device, start, end) -> Device:
    return device.moved(start).drawn(end)


def area(device: Device, corners) -> Device:
    device = device.moved_area(corners[0])
    for corner in corners[1:]:
        device = device.drawn_area(corner)
    return device.closed_area()


@pytest.mark.capability("G4.2-line")
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", range(40))
def test_a_line_has_the_pixels_nearest_to_it_between_points_of_two_or_three_components(dimension, seed):
    rng = np.random.default_rng(seed)
    start, end = rng.uniform(-20, 80, (2, dimension))
    if seed % 2:
        start, end = np.rint(start), np.rint(end)
    (x0, y0), (x1, y1) = (np.floor(p[:2] + 0.5) for p in (start, end))
    steps = int(max(abs(x1 - x0), abs(y1 - y0)))
    share = np.arange(steps + 1) / max(steps, 1)
    exact = np.stack([x0 + share * (x1 - x0), y0 + share * (y1 - y0)], axis=1)
    found = drawn_on(line(blank(), start, end))
    sure = np.abs(np.abs(exact - np.floor(exact)) - 0.5).min(axis=1) > 1e-9
    expected = {tuple(p) for p in np.rint(exact[sure]).astype(int).tolist()}
    inside = {(x, y) for x, y in expected if 0 <= x < COLUMNS and 0 <= y < ROWS}
    assert inside <= found
    assert len(found) - len(inside) <= (~sure).sum()


@pytest.mark.capability("G4.2-line")
@pytest.mark.parametrize("number", range(8))
def test_lines_along_the_axes_and_the_diagonals_are_exact(number):
    step = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)][number])
    middle = np.array((30, 20))
    found = drawn_on(line(blank(), middle, middle + 15 * step))
    assert found == {tuple((middle + k * step).tolist()) for k in range(16)}
    assert found == drawn_on(line(blank(), middle + 15 * step, middle))


def winding(corners: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether points lie inside a polygon, and how far from its sides."""
    after = np.roll(corners, -1, axis=0)
    d = after - corners
    arm = points[:, None] - corners
    share = np.clip((arm * d).sum(axis=2) / (d * d).sum(axis=1), 0, 1)
    away = np.linalg.norm(arm - share[..., None] * d, axis=2).min(axis=1)
    up = (corners[:, 1] <= points[:, None, 1]) & (after[:, 1] > points[:, None, 1])
    down = (corners[:, 1] > points[:, None, 1]) & (after[:, 1] <= points[:, None, 1])
    left = d[:, 0] * arm[..., 1] - d[:, 1] * arm[..., 0] > 0
    return ((up & left).sum(axis=1) - (down & ~left).sum(axis=1)) != 0, away


@pytest.mark.capability("G4.2-poly")
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("kind", ["convex", "star", "beyond the raster"])
@pytest.mark.parametrize("seed", range(12))
def test_a_polygon_has_the_pixels_whose_centres_it_covers(dimension, kind, seed):
    rng = np.random.default_rng(seed)
    sides = int(rng.integers(3, 9))
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, sides))
    reach = {"convex": 20.0, "star": rng.uniform(4, 22, sides), "beyond the raster": 45.0}[kind]
    if kind == "star":
        angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    corners = np.array((30.0, 22.0)) + np.stack([reach * np.cos(angle), reach * np.sin(angle)], axis=1)
    given = corners if dimension == 2 else np.column_stack([corners, rng.normal(size=sides)])
    found = drawn_on(area(blank(), given))
    row, column = np.mgrid[0:ROWS, 0:COLUMNS]
    centres = np.stack([column.ravel(), row.ravel()], axis=1).astype(float)
    inside, away = winding(corners, centres)
    sure = away > 1.0 / 256.0
    filled = np.array([tuple(p) in found for p in centres.astype(int).tolist()])
    assert np.array_equal(filled[sure], inside[sure])


@pytest.mark.capability("GB.1-port")
@pytest.mark.parametrize("seed", range(10))
def test_the_pseudo_screen_is_a_byte_a_pixel_row_after_row(seed):
    """What devices with a single page need: the whole screen in memory, and rows that go out as they are."""
    rng = np.random.default_rng(seed)
    device = blank()
    assert device.frame.pages.shape == (2, ROWS, COLUMNS, 1) and device.frame.pages.dtype == np.uint8
    column, row, number = int(rng.integers(COLUMNS)), int(rng.integers(ROWS)), int(rng.integers(1, 256))
    shown = device.with_colour(number).with_pixel(column, row).swapped().frame
    screen = shown.pages[shown.shown].tobytes()
    assert len(screen) == COLUMNS * ROWS and screen[row * COLUMNS + column] == number
    assert sum(map(bool, screen)) == 1


@pytest.mark.capability("GB.1-port")
@pytest.mark.parametrize(("start", "end"), [(3, 40), (40, 3), (-50, 10), (20, 900), (-5, 65), (7, 7), (70, 90)])
@pytest.mark.parametrize("row", [-1, 0, 17, ROWS - 1, ROWS])
def test_horizontal_lines_reach_from_one_column_to_another_within_the_screen(start, end, row):
    low, high = max(min(start, end), 0), min(max(start, end), COLUMNS - 1)
    expected = {(column, row) for column in range(low, high + 1)} if 0 <= row < ROWS else set()
    assert drawn_on(line(blank(), (start, row), (end, row))) == expected


@pytest.mark.capability("GB.1-port")
@pytest.mark.parametrize("place", [(-1, 5), (COLUMNS, 5), (5, -1), (5, ROWS), (-1000, 10**6)])
def test_pixels_outside_the_region_are_not_set_and_cannot_be_asked_for(place):
    assert not drawn_on(blank().with_pixel(*place))
    assert not drawn_on(line(blank(), place, place))
    with pytest.raises(InputError, match="outside the raster"):
        blank().pixel(*place)


@pytest.mark.capability("GB.1-port")
@pytest.mark.parametrize("below", [0, 1, 0b1010_1010, 255])
@pytest.mark.parametrize("number", [1, 0b0110_0110, 255])
def test_a_pixel_by_exclusive_or_comes_back(below, number):
    device = blank().cleared(below).with_colour(number)
    once = device.moved((9, 9)).rubber_band((9, 9))
    assert once.pixel(9, 9) == below ^ number and once.pixel(8, 9) == below
    assert once.rubber_band((9, 9)).pixel(9, 9) == below


@pytest.mark.capability("G4.4-hw-depthcue")
@pytest.mark.parametrize("seed", range(12))
def test_devices_with_depth_cueing_shade_lines_by_their_depths_while_it_is_on(seed):
    rng = np.random.default_rng(seed)
    start, end = rng.uniform((-10, -10, -3), (70, 55, 3), (2, 3))
    cueing = DepthCueing(-1.5, 2.0, 16, 47)
    plain = line(blank(), start, end)
    shaded = line(blank().with_depth_cueing(cueing), start, end)
    assert drawn_on(shaded) == drawn_on(plain), "the same pixels"
    (x0, y0), (x1, y1) = np.rint(start[:2]), np.rint(end[:2])
    for column, row in drawn_on(shaded):
        share = (column - x0) / (x1 - x0) if abs(x1 - x0) >= abs(y1 - y0) else (row - y0) / (y1 - y0)
        depth = start[2] + share * (end[2] - start[2])
        # Linear within the range, and no further beyond it.
        exact = 16 + 31 * min(max((depth + 1.5) / 3.5, 0.0), 1.0)
        assert abs(shaded.pixel(column, row) - exact) <= 0.5 + 1e-9
    # Off again: the colour counts, and depths do not.
    assert drawn_on(line(shaded.with_depth_cueing(None), start, end)) == drawn_on(plain)
    again = line(shaded.with_depth_cueing(None), start, end)
    assert {again.pixel(*place) for place in drawn_on(plain)} <= {7}


@pytest.mark.capability("G4.4-hw-depthcue")
def test_depth_cueing_by_a_device_is_that_of_the_verb_to_half_a_shade():
    """The nearest end has the top shade, the farthest a fifth, as in wireframes."""
    cueing = DepthCueing(-3.0, 5.0, round(LEAST * 31), 31)
    depth = np.linspace(-4.0, 6.0, 41)
    assert np.abs(cueing.numbers(depth) - 31 * depth_shades(depth, -3.0, 5.0)).max() <= 0.75
    for wrong in ((1.0, 1.0, 0, 9), (2.0, 1.0, 0, 9), (0.0, np.inf, 0, 9), (0.0, 1.0, -1, 9), (0.0, 1.0, 0, 256)):
        with pytest.raises(InputError):
            DepthCueing(*wrong)
    for start, end in (((1, 1), (5, 5, 0.0)), ((1, 1, 0.0), (5, 5))):
        with pytest.raises(InputError, match="depth"):
            line(blank().with_depth_cueing(cueing), start, end)


def solid(device):
    """How to draw lines on a device, one after the other."""

    def draw(p, q):
        return reduce(lambda so_far, ends: line(so_far, *ends), zip(p, q, strict=True), device)

    return draw


def by_or(frame):
    """How to draw lines in a framebuffer by exclusive or."""
    return lambda p, q: drawn_pixels.with_rubber_bands(frame, p, q, 7)


@pytest.mark.capability("G2.5-clip-draw-line")
@pytest.mark.parametrize("seed", range(12))
def test_every_way_of_clipping_goes_with_solid_exclusive_or_and_buffered_lines(seed):
    rng = np.random.default_rng(seed)
    start, end = rng.uniform(-40, 100, (2, 9, 2))
    window = Window(5, 40, 4, 30)
    clips = {
        "in the window": lambda p, q: clipped_lines.clip_lines_2d(p, q, window),
        "not at all": lambda p, q: clipped_lines.ClippedLines(p, q, np.ones(len(p), bool), np.zeros(len(p), bool)),
    }
    for name, clip in clips.items():
        lines = clip(start, end)
        expected = set()
        for a, b in zip(lines.start[lines.exists], lines.end[lines.exists], strict=True):
            expected |= drawn_on(line(blank(), a, b))
        frame = blank().frame

        plain = clip_and_draw(start, end, clip, solid(blank()))
        assert drawn_on(plain) == expected, name
        banded = clip_and_draw(start, end, clip, by_or(frame))
        again = clip_and_draw(start, end, clip, by_or(banded))
        assert np.array_equal(again.pages, frame.pages) and (banded.pages != frame.pages).any(), name
        # Buffered: on the page that is not seen, until the pages are exchanged.
        assert not plain.frame.picture().any() and plain.swapped().frame.picture().any()


@pytest.mark.capability("G2.5-clip-draw-line")
def test_lines_of_space_are_drawn_where_they_are_inside_and_not_at_all_outside():
    camera = Camera(eye=(0, -10, 0), target=(0, 0, 0), fov_deg=30)
    system = CoordinateSystem.of_screen(camera, PixelWindow(COLUMNS, ROWS, -1.0))
    space = Box(Window(0, COLUMNS - 1, 0, ROWS - 1))
    inside, crossing, outside = (
        [(-1.0, 0, 0.3), (1.0, 0, 0.3)],
        [(-0.5, 0, -1), (0.5, -30, 0)],
        [(50, 0, 0), (60, 1, 0)],
    )
    start, end = (system.homogeneous(np.array([pair[k] for pair in (inside, crossing, outside)])) for k in (0, 1))

    def clip(p, q):
        return clip_lines_3d(p, q, space)

    clipped = clip(start, end)
    assert clipped.exists.tolist() == [True, True, False] and clipped.clipped.tolist() == [False, True, True]
    expected = [system.from_world(np.array(p))[:2] for p in inside]
    assert np.allclose([clipped.start[0, :2], clipped.end[0, :2]], expected, atol=1e-9)
    separate = [drawn_on(line(blank(), clipped.start[k, :2], clipped.end[k, :2])) for k in range(2)]
    assert drawn_on(clip_and_draw(start, end, clip, solid(blank()))) == separate[0] | separate[1]
    assert not drawn_on(clip_and_draw(start[2:], end[2:], clip, solid(blank())))


@dataclass
class PostScript:
    """A device of its own in a few lines: what moves, lines and areas are on a page of PostScript."""

    text: list[str]

    def with_rgb(self, number, red, green, blue):
        self.text.append(f"/c{number} {{{red / 255} {green / 255} {blue / 255} setrgbcolor}} def")
        return self

    def with_colour(self, number):
        self.text.append(f"c{number}")
        return self

    def moved(self, point):
        self.text.append("{} {} moveto".format(*point))
        return self

    def drawn(self, point):
        self.text.append("{0} {1} lineto stroke {0} {1} moveto".format(*point))
        return self

    def moved_area(self, point):
        return self.moved(point)

    def drawn_area(self, point):
        self.text.append("{} {} lineto".format(*point))
        return self

    def closed_area(self):
        self.text.append("closepath fill")
        return self


@dataclass
class Recorder:
    """Another one, which writes down what it is told."""

    calls: list[tuple]

    def __getattr__(self, name):
        return lambda *values: self.calls.append((name, *values)) or self


def shown_on(device, drawing, place):
    """The device after a drawing, by the primitives alone."""
    numbers: dict[tuple[int, int, int], int] = {}
    for ink in page_marks(drawing).inks:
        for part in ink.parts:
            for low, high in zip(part.offsets[:-1], part.offsets[1:], strict=True):
                corners = [place(corner) for corner in part.microns[low:high] / 1000.0]
                rgb = tuple(part.colours[low].tolist()) if isinstance(part, Areas) else (0, 0, 0)
                if rgb not in numbers:
                    numbers[rgb] = len(numbers) + 1
                    device = device.with_rgb(numbers[rgb], *rgb)
                device = device.with_colour(numbers[rgb])
                filled = isinstance(part, Areas) and len(corners) > 2
                device = device.moved_area(corners[0]) if filled else device.moved(corners[0])
                for corner in corners[1:]:
                    device = device.drawn_area(corner) if filled else device.drawn(corner)
                device = device.closed_area() if filled else device
    return device


@pytest.mark.slow
@pytest.mark.capability("G4.1-device")
@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_the_raster_postscript_and_a_recorder_show_a_drawing_by_the_same_handful_of_primitives(verb, tmp_path):
    items = (vp.Item("A", box((0, 0, 0), (3, 2, 1)), "orange"), vp.Item("B", box((1, -2, 0), (2, -1, 4)), "blue"))
    drawing = verb(vp.Scene(items), page=vp.Page(COLUMNS, ROWS, 4.0))
    dots, wide, high = 10, 10 * COLUMNS, 10 * ROWS
    raster = Device().opened(wide, high).with_rgb(0, 255, 255, 255)
    raster = shown_on(raster, drawing, lambda p: (dots * p[0] - 0.5, high - dots * p[1] - 0.5)).swapped()
    header = f"%!PS\n0.72 dup scale 0.5 setlinewidth 0 0 {wide} {high} rectclip"
    page = shown_on(PostScript([header]), drawing, lambda p: (dots * p[0], dots * p[1]))
    calls = shown_on(Recorder([]), drawing, tuple).calls
    (tmp_path / "a.ps").write_text("\n".join([*page.text, "showpage"]), encoding="ascii")
    size = (f"-g{wide}x{high}", "-dFIXEDMEDIA", "-r100", "-sDEVICE=ppmraw", "-sOutputFile=%stdout")
    theirs = grey_of_pgm(run("gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", *size, tmp_path / "a.ps"))
    ours = raster.frame.picture().mean(axis=2) / 255.0
    assert ours.shape == theirs.shape and ours.min() < 0.5
    # Two pixels away from where colours change both show the same.
    around = np.array([np.roll(ours, (i, j), (0, 1)) for i in range(-2, 3) for j in range(-2, 3)])
    assert np.abs(ours - theirs)[np.ptp(around, axis=0) < 0.01].max() < 0.01
    assert (np.abs(around - theirs).min(axis=0) > 0.01).mean() < 1e-3
    assert {name for name, *_ in calls} <= {"with_rgb", "with_colour", "moved", "drawn"} | {
        "moved_area",
        "drawn_area",
        "closed_area",
    }
    marks = sum(len(part) for ink in page_marks(drawing).inks for part in ink.parts)
    assert sum(name in ("moved", "moved_area") for name, *_ in calls) == marks
