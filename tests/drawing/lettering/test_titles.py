"""Titles and frames."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.verbs import vectorplot
from vectorplot.geometry import box

CUBE = vp.Item("CUBE", box((2, 2, 2)))
PAGE = vp.Page(120, 90)


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_title_and_frame_stand_in_the_margin_and_move_nothing(verb) -> None:  # type: ignore[no-untyped-def]
    plain, framed = verb(CUBE, page=PAGE), verb(CUBE, page=PAGE, title="Ein Würfel", frame=True)
    assert [layer.name for layer in framed.layers] == [*(layer.name for layer in plain.layers), "frame"]
    for one, other in zip(plain.layers, framed.layers, strict=False):
        assert all(np.array_equal(a.points, b.points) for a, b in zip(one.strokes, other.strokes, strict=True))
    (paths,) = framed.layers[-1].strokes
    inside = (paths.points > 9.999) & (paths.points < np.array([110.001, 80.001]))
    assert not inside.all(axis=1).any() and (paths.points > 0).all()
    parts = [shapely.LineString(paths.points[a:b]) for a, b in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)]
    border = [part for part in parts if part.length > 50.0]
    letters = [part for part in parts if part.length <= 50.0]
    assert len(border) == 1 and len(letters) > 8
    assert shapely.distance(shapely.union_all(border), shapely.union_all(letters)) > 3.0
    assert shapely.union_all(letters).bounds[0] == pytest.approx(120 - shapely.union_all(letters).bounds[2], abs=1.5)


def test_frames_are_cut_for_plotters_that_stutter() -> None:
    (paths,) = vp.draw(CUBE, page=PAGE, frame=True, longest_mm=20.0).layers[-1].strokes
    long = [np.hypot(*np.diff(paths.points[a:b], axis=0).T).sum() for a, b in zip(paths.offsets, paths.offsets[1:])]  # noqa: B905
    assert max(long) <= 20.0 + 1e-9 and sum(long) == pytest.approx(2 * (110 + 80))


def test_what_cannot_be_set_is_one_line() -> None:
    for wrong in ({"title": "漢"}, {"title": "wide " * 40}, {"frame": True, "page": vp.Page(50, 50, 0)}):
        with pytest.raises(vp.InputError):
            vp.draw(CUBE, **{"page": PAGE, **wrong})  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["strokes", "real"])
@pytest.mark.parametrize(("words", "lines"), [(4, 1), (6, 1), (10, 2)])
def test_titles_that_are_too_wide_are_smaller_and_then_in_several_lines(words: int, lines: int, text: str) -> None:
    page = vp.Page(80, 60, 9.0)
    (*_, frame) = vp.draw(CUBE, page=page, title="wide " * (words - 1) + "ones", text=text).layers  # type: ignore[arg-type]
    if text == "real":
        texts = frame.marks[-1]
        assert len(texts) == lines and (texts.size_mm >= 2.5).all() and (texts.room_mm <= 80.0).all()
    else:
        (paths,) = frame.strokes
        x, y = paths.points.T
        assert 0.0 < x.min() and x.max() < 80.0 and 0.0 < y.min() and y.max() < 9.0
        assert x.min() + x.max() == pytest.approx(80.0, abs=1.5)


@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_the_command_has_them_too(verb: str, tmp_path) -> None:  # type: ignore[no-untyped-def]
    scene, out = tmp_path / "cube.scene", tmp_path / "cube.svg"
    scene.write_text("CUBE red box solid 2 2 2", encoding="utf-8")
    done = CliRunner().invoke(vectorplot, [verb, str(scene), "--title", "Cube", "--frame", "-o", str(out)])
    assert done.exit_code == 0 and " frame" in out.read_text(encoding="utf-8")


@pytest.mark.parametrize("margin", [0.0, 1.0, 3.0, 4.0])
def test_no_letter_of_a_title_reaches_over_the_edge(margin: float) -> None:
    (paths,) = vp.draw(CUBE, page=vp.Page(80, 60, margin), title="gyp gyp").layers[-1].strokes
    assert paths.points[:, 1].min() >= 0.5 - 1e-9
