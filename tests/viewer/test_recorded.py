"""A recording by hand becomes one movie: its states drawn exactly, on one page, in every format."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace

import pytest

import vectorplot as vp
from vectorplot.animation.movies import read_movie
from vectorplot.errors import InputError
from vectorplot.geometry.solids import box
from vectorplot.viewer.answers import MOST_FRAMES, recorded_pictures, recorded_states, write_recorded
from vectorplot.viewer.pictures import Job, SupersededError
from vectorplot.viewer.state import first_state

SCENE = vp.Scene((vp.Item("die", box((1, 2, 1))),), camera=vp.Camera((4, -5, 3)), page=vp.Page(60, 40, 2))
FIRST = first_state(SCENE).values()
FRAMES = [FIRST, {"azimuth": 0.3}, {}, {"mode": "pixels", "landscape": True}]


def asked(format_, frames=FRAMES, fps=25.0):
    return {"frames": frames, "fps": fps, "format": format_}


def test_frames_say_what_is_new_in_them():
    states = recorded_states(FRAMES)
    assert [state.azimuth for state in states] == [FIRST["azimuth"], 0.3, 0.3, 0.3]
    assert [state.mode for state in states] == ["lines", "lines", "lines", "pixels"]


@pytest.mark.parametrize(
    ("frames", "words"),
    [
        ([], "nothing was recorded"),
        (None, "nothing was recorded"),
        ([FIRST, 3], "a mapping"),
        ([{"azimuth": "north"}], "azimuth"),
        ([FIRST, *[{}] * MOST_FRAMES], f"at most {MOST_FRAMES}"),
    ],
    ids=["empty", "none", "number", "words", "many"],
)
def test_what_is_no_recording_is_refused(frames, words):
    with pytest.raises(InputError, match=words):
        recorded_states(frames)


def test_frames_have_one_page_pixels_become_polygons_and_what_stands_still_is_drawn_once():
    frames = list(recorded_pictures(recorded_states(FRAMES), SCENE, Job()))
    assert {(frame.width_mm, frame.height_mm) for frame in frames} == {(60.0, 40.0)}
    assert frames[1] is frames[2] and frames[0] is not frames[1]
    assert any(layer.fills for layer in frames[3].layers)


@pytest.mark.parametrize(("format_", "head"), [("svg", b"<?xml"), ("pdf", b"%PDF"), ("mp4", b"\0\0\0")])
def test_movies_are_of_the_formats_of_animate(format_, head):
    name, content = write_recorded(asked(format_, FRAMES[:2]), SCENE, "die", None, Job())
    assert name == f"die.{format_}" and content.startswith(head)


def test_movies_of_polygons_are_two_files_in_an_archive_or_beside_each_other(tmp_path):
    name, content = write_recorded(asked("vd1"), SCENE, "die", None, Job())
    path = tmp_path / "video" / "turn.vd1"
    assert name == "die.zip" and write_recorded(asked(None), SCENE, "die", path, Job()) == (str(path), b"")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert [archive.read(f"die.{suffix}") for suffix in ("vd1", "vd2")] == [
            path.with_suffix(f".{suffix}").read_bytes() for suffix in ("vd1", "vd2")
        ]
    assert len(read_movie(path.with_suffix(""))) == len(FRAMES)


@pytest.mark.parametrize(
    "wrong", [asked("exe"), asked(None), asked("svg", fps="fast"), asked("svg", fps=0)], ids=["exe", "none", "fps", "0"]
)
def test_what_cannot_be_written_is_one_line(wrong):
    with pytest.raises(InputError):
        write_recorded(wrong, SCENE, "die", None, Job())


def test_a_recording_that_is_stopped_leaves_no_file_and_counts_as_far_as_it_came(tmp_path):
    job = Job()
    frames = recorded_pictures(recorded_states(FRAMES), SCENE, job)
    next(frames)
    next(frames)
    assert job.frames == (1, 4)
    job.stopped.set()
    with pytest.raises(SupersededError):
        next(frames)
    with pytest.raises(SupersededError):
        write_recorded(asked("svg"), SCENE, "die", tmp_path / "turn.svg", replace(job))
    assert list(tmp_path.iterdir()) == []
