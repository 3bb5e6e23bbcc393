"""Pictures that keep an error, or a time."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.line_distances import distances
from support.pixel_errors import averages, error, outside
from support.top_fills import fills_of, top_at

import vectorplot as vp
from vectorplot.pictures import promises
from vectorplot.pictures.pipeline import StageReport
from vectorplot.pictures.promises import DRAWING, PAINTING, RENDERING, off_by_of, promised, within_of
from vectorplot.testing.drawings import lines_by_group

DATA = Path(__file__).parents[1] / "data"

TORUS, CUBES, TABLE = (DATA / f"{name}.scene" for name in ("torus", "cubes", "table"))


def told(verb: Callable[..., object], scene: object, **options: object) -> tuple[object, StageReport]:
    """The picture, and what was told of its promise."""
    reports: list[StageReport] = []
    made = verb(scene, explain=reports.append, **options)
    return made, reports[-1]


def segments(drawing: vp.Drawing) -> np.ndarray:
    """(n,2,2) all its lines."""
    return np.concatenate(list(lines_by_group(drawing).values()))


@pytest.mark.parametrize("name", ["torus", "capped", "curvature_lines"])
@pytest.mark.parametrize("error", [0.1, 0.005])
def test_drawn_lines_are_within_the_error_of_lines_fifty_times_finer(name: str, error: float) -> None:
    made, report = told(vp.draw, DATA / f"{name}.scene", off_by=f"{error}mm")
    fine = segments(vp.draw(DATA / f"{name}.scene", tolerance_mm=0.02 * error, curves="polyline"))
    assert isinstance(made, vp.Drawing)
    lines = segments(made)
    part = np.linspace(0.0, 1.0, 5)[:, None, None]
    places = ((1.0 - part) * lines[:, 0] + part * lines[:, 1]).reshape(-1, 2)
    reached = distances(places[:: 1 + len(places) // 20000], list(fine)).max()
    assert reached <= error
    assert report.name == "promise"
    assert reached <= float(re.findall(r"off by ([0-9.e-]+) mm", report.why)[0]) <= error


def test_lines_of_polyhedra_are_exact_at_once() -> None:
    _, report = told(vp.draw, CUBES, off_by="1e-5mm")
    assert (report.name, report.count) == ("promise", 1)
    assert report.why.startswith("off by nothing (hidden lines exact), ")


def test_painted_outlines_and_shades_keep_their_errors() -> None:
    scene = vp.Scene((vp.Item("ring", vp.surfaces.Torus(3.0, 1.0)),), camera=vp.Camera((6, -5, 4)))
    _, report = told(vp.paint, scene, off_by="0.01mm")
    mm = re.findall(r"off by ([0-9.e-]+) mm", report.why)
    assert report.name == "promise" and 0.0 < float(mm[0]) <= 0.01
    _, finer = told(vp.paint, scene, off_by="0.5mm,9shades")
    assert finer.name == "promise"
    assert float(re.findall(r"([0-9.]+) shades", finer.why)[0]) <= 9.0


def placed(drawing: vp.Drawing, points: np.ndarray) -> np.ndarray:
    """(n,2) where on a page points (n,3) of the world are."""
    there = np.column_stack([points, np.ones(len(points))]) @ drawing.page_from_world.T
    return there[:, :2] / there[:, 3:]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["torus", "revolutions", "capped", "conic_section"])
def test_what_is_painted_beside_contours_is_what_a_finer_picture_shows_there(name: str) -> None:
    error = 0.05
    scene = vp.read(DATA / f"{name}.scene")
    pictures = vp.paint(scene, off_by=error), vp.paint(scene, tolerance_mm=error / 8.0)
    drawing = vp.draw(scene, lines="contour", tolerance_mm=error / 8.0)
    ends = segments(drawing)
    way = ends[:, 1] - ends[:, 0]
    long = np.hypot(*way.T) > 1e-3
    across = way[long] @ [[0.0, 1.0], [-1.0, 0.0]] / np.hypot(*way[long].T)[:, None]
    middle = ends[long].mean(axis=1)
    beside = np.concatenate([middle + 1.25 * error * across, middle - 1.25 * error * across])
    beside = beside[np.random.default_rng(0).permutation(len(beside))[:600]]
    # Pages that are fitted differ by a scale and a shift.
    world = (
        scene.bounds.mean(axis=0) + np.random.default_rng(1).normal(size=(9, 3)) * np.ptp(scene.bounds, axis=0) / 9.0
    )
    source = np.column_stack([placed(drawing, world), np.ones(len(world))])
    seen = []
    for picture in pictures:
        onto = np.linalg.lstsq(source, placed(picture, world))[0]
        fills, at = fills_of(picture), np.column_stack([beside, np.ones(len(beside))]) @ onto
        top = top_at(fills, at)
        seen.append(np.where(top >= 0, fills.item[np.maximum(top, 0)], -1))
    assert len(beside) > 60 and (seen[0] >= 0).any()
    assert (seen[0] != seen[1]).mean() < 0.005


def test_pixels_get_as_many_samples_as_their_error_wants_and_exact_shadows() -> None:
    reports: list[StageReport] = []
    made = vp.render(TABLE, off_by="0.25px", size=(80, 60), explain=reports.append)
    assert reports[-1].name == "promise" and "px" in reports[-1].why
    assert any(report.name == "shadows" and "exactly" in report.why for report in reports)
    # Table has no smooth surfaces: half a sample of three.
    fine = vp.render(TABLE, samples=3, shadows="exact", size=(80, 60))
    assert np.array_equal(made.pixels, fine.pixels)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["house", "table", "torus"])
@pytest.mark.parametrize("off_by", [0.5, 0.25])
def test_pixels_are_within_the_error_of_a_picture_with_sixty_four_samples(name: str, off_by: float) -> None:
    said, found = error(vp.read(DATA / f"{name}.scene"), off_by)
    assert said.name == promises.PROMISE
    assert found <= off_by


def test_a_picture_moved_by_a_pixel_is_told() -> None:
    fine = np.zeros((64, 64, 3))
    fine[:, 24:] = 200.0
    right, moved = averages(fine), averages(np.roll(fine, 8, axis=1))
    assert outside(right, fine, 0.125) == 0.0
    assert outside(moved, fine, 0.5) > 0.0 and outside(moved[:, 1:], fine[:, 8:], 1.0) == 0.0


def test_what_cannot_be_kept_is_said_with_what_was_reached() -> None:
    with pytest.warns(vp.InputWarning, match=r"^0\.01 px could not be kept: off by 0\.0\d+ px, .* s$"):
        vp.render(CUBES, off_by="0.01px", size=(20, 15))


# How time is spent, by a clock of the test's own.


class Clock:
    """Pictures that take as long as they are told to."""

    def __init__(self, seconds: Callable[[float], float], error: Callable[[float], float]) -> None:
        self.now, self.made = 0.0, []
        self.seconds, self.error = seconds, error

    def picture(self, *, tolerance_mm: float, progress: Callable, explain: Callable) -> float:
        self.made.append(tolerance_mm)
        for part in range(1000):
            self.now += self.seconds(tolerance_mm) / 1000.0
            progress("curves", (part + 1) / 1000.0)
        explain(StageReport("curves", "", 0.0, 1, 1.0, self.error(tolerance_mm), "mm"))
        return tolerance_mm

    def promised(self, monkeypatch: pytest.MonkeyPatch, **asked: object) -> tuple[float, StageReport]:
        monkeypatch.setattr(promises.time, "perf_counter", lambda: self.now)
        reports: list[StageReport] = []
        given = {"off_by": None, "within": None, "tolerance_mm": 0.02, "progress": None, "explain": reports.append}
        return promised(self.picture, DRAWING, given | asked), reports[-1]


def test_time_is_spent_on_finer_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(lambda tolerance: 0.2 + 0.01 / tolerance**0.5, lambda tolerance: 0.5 * tolerance)
    finest, report = clock.promised(monkeypatch, within="3s")
    assert report.name == "promise"
    assert clock.now <= 3.0
    assert finest < 1e-3
    assert finest == min(clock.made)


def test_a_picture_that_takes_longer_than_was_foretold_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(lambda tolerance: 0.2 if tolerance > 0.05 else 50.0, lambda tolerance: tolerance)
    finest, report = clock.promised(monkeypatch, within=1.0)
    assert report.name == "promise" and clock.now <= 1.0
    assert finest == clock.made[0] and len(clock.made) == 2


def test_an_error_that_is_measured_too_large_makes_a_finer_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(lambda tolerance: 0.1, lambda tolerance: 3.0 * tolerance)
    value, report = clock.promised(monkeypatch, off_by="0.01mm")
    assert report.name == "promise" and report.count == 2
    assert 3.0 * value <= 0.01
    stubborn = Clock(lambda tolerance: 0.1, lambda tolerance: 1.0)
    with pytest.warns(vp.InputWarning, match="could not be kept: off by 1 mm"):
        stubborn.promised(monkeypatch, off_by="0.01mm")
    assert len(stubborn.made) <= promises.TRIES


def test_warnings_are_those_of_the_picture_that_is_taken() -> None:
    def picture(*, tolerance_mm: float, progress: object, explain: Callable) -> float:
        warnings.warn(f"at {tolerance_mm:g}", vp.InputWarning, stacklevel=1)
        explain(StageReport("curves", "", 0.0, 1, 1.0, 2.0 * tolerance_mm, "mm"))
        return tolerance_mm

    given = {"off_by": 0.1, "within": None, "tolerance_mm": 0.02, "progress": None, "explain": None}
    with pytest.warns(vp.InputWarning) as caught:
        value = promised(picture, DRAWING, given)
    assert [str(one.message) for one in caught] == [f"at {value:g}"]


# What may be asked for.


def test_units() -> None:
    assert off_by_of(0.01, *DRAWING.units) == {"mm": 0.01}
    assert off_by_of(" 0.1 cm ", *DRAWING.units) == {"mm": 1.0}
    assert off_by_of("0.01mm,4shades", *PAINTING.units) == {"mm": 0.01, "shades": 4.0}
    assert off_by_of("0.5", *RENDERING.units) == {"px": 0.5}
    assert [within_of(text) for text in (2, "2", "300ms", "2min")] == [2.0, 2.0, 0.3, 120.0]


@pytest.mark.parametrize("asked", ["", "x", "0mm", "-1mm", "nan", "inf", "1e999mm", "1px", "1mm,2mm", "1.2.3mm", "mm"])
def test_impossible_errors_are_refused(asked: str) -> None:
    with pytest.raises(vp.InputError, match=r"off_by .* expected a positive number of mm"):
        vp.draw(CUBES, off_by=asked)


@pytest.mark.parametrize("asked", ["", "x", 0, -1.0, "0s", float("nan"), float("inf"), "1h"])
def test_impossible_times_are_refused(asked: object) -> None:
    with pytest.raises(vp.InputError, match=r"within .* expected a positive time"):
        vp.draw(CUBES, within=asked)


def test_an_accuracy_besides_is_refused() -> None:
    with pytest.raises(vp.InputError, match="tolerance_mm does not go with off_by"):
        vp.draw(CUBES, off_by=0.1, tolerance_mm=0.5)


# The command.


def command(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "vectorplot", *arguments], capture_output=True, text=True, cwd=cwd, timeout=600
    )


def test_the_command_says_what_was_reached(tmp_path: Path) -> None:
    done = command("draw", str(TORUS), "-o", "t.svg", "--off-by", "0.01mm", cwd=tmp_path)
    assert done.returncode == 0
    assert re.fullmatch(r"vectorplot: off by 0\.0\d+ mm \(hidden lines exact\), \d+\.\d\d s\n", done.stderr)
    assert command("draw", str(TORUS), "-o", "q.svg", "--off-by", "0.01mm", "-q", cwd=tmp_path).stderr == ""


def test_strict_writes_nothing_where_a_promise_is_broken(tmp_path: Path) -> None:
    arguments = ("render", str(CUBES), "-o", "c.png", "--size", "20x15", "--off-by", "0.01px")
    kind = command(*arguments, cwd=tmp_path)
    assert kind.returncode == 0 and "warning: 0.01 px could not be kept: off by" in kind.stderr
    (tmp_path / "c.png").unlink()
    strict = command(*arguments, "--strict", cwd=tmp_path)
    assert strict.returncode == 1 and "not kept: off by" in strict.stderr
    assert not (tmp_path / "c.png").exists()
