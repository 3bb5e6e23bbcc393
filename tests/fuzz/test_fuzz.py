"""Hostile files of every format, and hostile scenes for every verb: one line or a result, within bounds.

A fixed part of the campaign that campaign.py runs for hours: the same files every time, a few seconds. hypothesis runs
the same generators, so that what it finds shrinks."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from random import Random

import pytest
from fuzz.fuzz_meshes import MESHES, mesh_bytes
from fuzz.fuzz_oracle import FILES, TARGETS, VERBS, attack, finding, judged
from fuzz.fuzz_scenes import formula_text, scene_bytes
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support import pace
from support.effort import examples, several

from vectorplot.io.read_file import read

COUNTS = {**dict.fromkeys(TARGETS, 250), "formula": 600, "draw": 16, "paint": 12, "render": 20, "info": 100}
"""How many files of its stream each target gets by hand, and two fifths of them at every change."""

SHRINKING = settings(
    max_examples=examples(60),
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large],
)


@pytest.mark.slow
@pytest.mark.hard(53)
@pytest.mark.parametrize("target", TARGETS)
def test_hostile_input_gives_one_line_or_a_result(tmp_path: Path, target: str) -> None:
    for number in range(several(2 * COUNTS[target] // 5, long=COUNTS[target])):
        found, data, suffix, _ = attack(target, f"test {number}", tmp_path)
        assert found is None, f"{target}, 'test {number}', .{suffix}: {data[:2000]!r}\n{found.story}"


@pytest.mark.parametrize("suffix", list(MESHES))
@SHRINKING
@given(rng=st.randoms(use_true_random=False))
def test_mesh_files_that_shrink(tmp_path: Path, suffix: str, rng: Random) -> None:
    assert judged(suffix, mesh_bytes(rng, suffix), suffix, tmp_path) is None


@pytest.mark.slow
@SHRINKING
@given(rng=st.randoms(use_true_random=False))
def test_scene_files_that_shrink(tmp_path: Path, rng: Random) -> None:
    assert judged("scene", scene_bytes(rng), "scene", tmp_path) is None


@SHRINKING
@given(rng=st.randoms(use_true_random=False))
def test_formulas_that_shrink(tmp_path: Path, rng: Random) -> None:
    assert judged("formula", formula_text(rng).encode("utf-8", "surrogatepass"), "txt", tmp_path) is None


@pytest.mark.parametrize("suffix", FILES)
def test_arbitrary_bytes(tmp_path: Path, suffix: str) -> None:
    rng = Random(suffix)
    for number in range(60):
        path = tmp_path / f"input{number}.{suffix}"
        path.write_bytes(bytes(rng.randrange(256) for _ in range(rng.randrange(1, 200))))
        assert finding(lambda path=path: read(path), 2.0) is None


@pytest.mark.slow
def test_the_campaign_runs_as_its_page_says(tmp_path: Path) -> None:
    command = [sys.executable, "tests/fuzz/campaign.py", "--target", "off", "--count", "20", "--keep", str(tmp_path)]
    done = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, timeout=600)
    assert done.stdout.startswith("off: 20 inputs in"), done.stderr


def test_the_oracle_finds_what_it_is_for(tmp_path: Path) -> None:
    def endless() -> None:
        while True:
            pass

    def lie() -> None:
        raise KeyError("x")

    too_long, wrong = finding(endless, 0.05), finding(lie, 1.0)
    assert too_long is not None and too_long.cause.startswith("too long")
    assert wrong is not None and wrong.cause.startswith("KeyError")
    assert set(VERBS) <= set(TARGETS)


def test_on_a_slow_machine_there_is_more_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pace, "BARE_S", 1e-6)
    with pace.cpu_seconds(0.001):
        for _ in range(10):
            pace.bare_work()
    monkeypatch.setattr(pace, "BARE_S", 1.0)
    with pytest.raises(pace.TooLong, match=r"1\.0 times as long"), pace.cpu_seconds(0.01):
        while True:
            pace.bare_work()
