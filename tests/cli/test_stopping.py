"""Whatever stops the command, at whatever stage: one line, no half-written file, the old file untouched."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from support.effort import several
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.main import run, stoppable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.save import write

SCENE = """
light LAMP position 4 -6 9
FLOOR gray box 6 6 0.1 translation -3 -3 -0.2
CUBE blue box 2 2 2 translation -1 -1 0 patterns face 6 polygon SPOT red 0 0, 0.5 0, 0 0.5
GLASS transparent refraction 1.4 box 1 1 1 translation 1.2 -2 0
MIRROR mirror box 0.1 3 3 translation -2.5 -1 0
"""
PLAIN = "CUBE blue box 2 2 2 translation -1 -1 0\n"
BALL = "BALL red surface sphere 0.6 translation 0 0 2.7\n"

COMMANDS = [
    ["draw", "--hidden", "dashed", "--halo", "0.5", "--lines", "contour,crease,pattern,intersection"],
    ["draw", "--style", "wireframe"],
    ["paint", "--lines", "contour"],
    ["paint", "--fills", "visible"],
    ["paint", "--fills", "erasing"],
    ["render", "--size", "60x40", "--lines", "contour"],
]

SIGNALS = [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated"), (signal.SIGHUP, 129, "hung up")]


@pytest.fixture
def place(tmp_path):
    """A scene file, and an old picture that is to be replaced."""
    scene = tmp_path / "all.scene"
    scene.write_text(SCENE, encoding="utf-8")
    return scene


@pytest.mark.slow
def test_a_signal_amid_curves_of_smooth_surfaces_leaves_one_line(place, monkeypatch, capsys):
    place.write_text(SCENE + BALL, encoding="utf-8")
    arguments, out = command(place, COMMANDS[1])
    whole = walked(arguments, monkeypatch)
    capsys.readouterr()
    for number, stage in enumerate(whole.stages):
        if stage in ("curves", "smooth surfaces"):
            command(place, COMMANDS[1])
            with monkeypatch.context() as patch, stoppable():
                stop_at(number, lambda: os.kill(os.getpid(), signal.SIGTERM), whole, patch)
                assert run(arguments) == 143
            assert capsys.readouterr().err == "vectorplot: terminated\n"
            assert_untouched(out, place)


def command(scene: Path, words: list[str]) -> tuple[list[str], Path]:
    out = scene.parent / ("old.png" if words[0] == "render" else "old.svg")
    out.write_text("old", encoding="utf-8")
    return [words[0], str(scene), "-o", str(out), *words[1:]], out


def assert_untouched(out: Path, scene: Path) -> None:
    assert out.read_text(encoding="utf-8") == "old"
    assert sorted(path.name for path in scene.parent.iterdir()) == ["all.scene", out.name]


@dataclass(frozen=True)
class Walked:
    """The stages of a run in their order; what each gave, and how many had begun when it ended."""

    stages: list[str]
    results: dict[int, Any]
    ends: dict[int, int]


def walked(arguments: list[str], monkeypatch) -> Walked:
    found, real = Walked([], {}, {}), Pipeline.run

    def recorded(walk, name, *rest, **more):
        number = len(found.stages)
        found.stages.append(name)
        found.results[number] = real(walk, name, *rest, **more)
        found.ends[number] = len(found.stages)
        return found.results[number]

    with monkeypatch.context() as patch:
        patch.setattr(Pipeline, "run", recorded)
        assert run(arguments) == 0
    return found


@cache
def whole_walk(words: tuple[str, ...]) -> Walked:
    """What a command does that nothing stops: the same for every test, wherever its files lie."""
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        scene = Path(folder) / "all.scene"
        scene.write_text(SCENE, encoding="utf-8")
        return walked(command(scene, list(words))[0], patch)


def stop_at(number: int, what, before: Walked, monkeypatch) -> None:
    """From the stage with this number on, call what; in the middle of the stage's own work where that is the last. What
    the stages before it gave in a whole run need not be found again."""
    real, begun = Pipeline.run, [0]

    def stopping(self, name, function, *rest, **more):
        here = begun[0]
        assert before.stages[here] == name
        begun[0] = here + 1
        if before.ends[here] <= number:
            begun[0] = before.ends[here]
            return before.results[here]
        if here < number:
            return real(self, name, function, *rest, **more)

        def stopped(*args, **kwargs):
            function(*args, **kwargs)
            what()

        return real(self, name, stopped, *rest, **more)

    monkeypatch.setattr(Pipeline, "run", stopping)


@pytest.mark.slow
@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_a_signal_at_any_stage_leaves_one_line_and_the_old_file(words, place, monkeypatch, capsys):
    arguments, out = command(place, words)
    whole = whole_walk(tuple(words))
    assert len(whole.stages) > 5 and whole.stages[-1] == "write"
    capsys.readouterr()
    # The commands take turns at the stages, most of which they have in common.
    for number in range(several(COMMANDS.index(words) % 2, long=0), len(whole.stages), several(2, long=1)):
        sent, status, said = SIGNALS[number % len(SIGNALS)]
        command(place, words)
        with monkeypatch.context() as patch, stoppable():
            stop_at(number, lambda sent=sent: os.kill(os.getpid(), sent), whole, patch)
            assert run(arguments) == status, whole.stages[number]
        assert capsys.readouterr().err == f"vectorplot: {said}\n"
        assert_untouched(out, place)


@pytest.mark.slow
@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
@pytest.mark.parametrize(
    ("error", "line"),
    [
        (MemoryError(), "there is not enough memory for this"),
        (OSError(28, os.strerror(28)), os.strerror(28)),
    ],
    ids=["memory", "disk"],
)
def test_what_runs_out_at_any_stage_is_said_in_one_line(words, error, line, place, monkeypatch, capsys):
    arguments, out = command(place, words)
    whole = whole_walk(tuple(words))
    capsys.readouterr()

    def fail():
        raise error

    for number in (0, len(whole.stages) // 2, len(whole.stages) - 1):
        command(place, words)
        with monkeypatch.context() as patch:
            stop_at(number, fail, whole, patch)
            assert run(arguments) == 1
        assert capsys.readouterr().err == f"vectorplot: {line}\n"
        assert_untouched(out, place)


def limited(code: str, arguments: list[str], **more) -> subprocess.CompletedProcess[bytes]:
    script = f"import resource, sys\n{code}\nfrom vectorplot.cli.main import main\nmain()"
    return subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, timeout=600, **more)


@pytest.mark.slow
@pytest.mark.parametrize("words", [COMMANDS[0], COMMANDS[2]], ids=" ".join)
def test_a_disk_that_fills_up_leaves_the_old_file(words, place):
    place.write_text(PLAIN, encoding="utf-8")
    arguments, out = command(place, words)
    result = limited("resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))", arguments)
    assert result.returncode == 1
    assert result.stderr.decode().splitlines() == [f"vectorplot: {out}: {os.strerror(27)}"]
    assert_untouched(out, place)


def test_a_signal_while_the_command_loads_is_one_line(place):
    arguments, out = command(place, COMMANDS[0])
    code = "import builtins, os, signal\nreal = builtins.__import__\n"
    code += "def late(name, *rest):\n    if name == 'click': os.kill(os.getpid(), signal.SIGTERM)\n"
    code += "    return real(name, *rest)\nbuiltins.__import__ = late"
    result = limited(code, arguments)
    assert (result.returncode, result.stderr) == (143, b"vectorplot: terminated\n")
    assert_untouched(out, place)


def test_a_signal_amid_the_making_of_a_class_is_one_line(place):
    # Python makes another error of whatever is raised there.
    arguments, out = command(place, COMMANDS[0])
    code = "import functools, os, signal\nreal = functools.cached_property.__set_name__\n"
    code += "def late(self, owner, name):\n"
    code += "    if owner.__module__.startswith('vectorplot.scene'): os.kill(os.getpid(), signal.SIGTERM)\n"
    code += "    real(self, owner, name)\nfunctools.cached_property.__set_name__ = late"
    result = limited(code, arguments)
    assert (result.returncode, result.stderr) == (143, b"vectorplot: terminated\n")
    assert_untouched(out, place)


LONG = "".join(f"RING{k} blue surface torus 3 1 rotation x {7 * k} translation {k} 0 0\n" for k in range(30))


@pytest.mark.slow
@pytest.mark.parametrize("latest", [0.02, 0.3])
def test_ctrl_c_at_any_moment_after_the_first_line_is_one_line(place, latest):
    # Python tells what it has imported: when Ctrl-C has been told what to do, the rest of the command comes.
    arguments, out = command(place, ["draw"])
    # So much is to be drawn that no moment comes too late.
    place.write_text(SCENE + LONG, encoding="utf-8")
    moments = random.Random(7)
    for _ in range(several(8, long=80)):
        command(place, ["draw"])
        words = [sys.executable, "-X", "importtime", "-m", "vectorplot", *arguments]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            assert process.stderr is not None
            next(line for line in process.stderr if line.rstrip().endswith(b"vectorplot.cli"))
            time.sleep(moments.uniform(0.0, latest))
            process.send_signal(signal.SIGINT)
            said = [line for line in process.stderr if not line.startswith(b"import time:")]
        assert (process.returncode, said) == (130, [b"vectorplot: interrupted\n"]), b"".join(said).decode()
        assert_untouched(out, place)


def test_a_signal_that_was_ignored_stays_so():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stoppable():
            os.kill(os.getpid(), signal.SIGHUP)
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_outside_the_main_thread_there_are_no_signals():
    done = []

    def work():
        with stoppable():
            done.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [True]


@pytest.mark.slow
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_nobody_reads_what_is_said(stream, place):
    place.write_text(PLAIN, encoding="utf-8")
    reading, writing = os.pipe()
    os.close(reading)
    arguments = ["draw", str(place), "-o", "-", "--format", "svg", "--explain"]
    with os.fdopen(writing, "wb") as pipe:
        others = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: pipe}
        result = subprocess.run([sys.executable, "-m", "vectorplot", *arguments], timeout=600, **others)
    assert result.returncode == 1
    assert b"Traceback" not in (result.stderr or b"")


@pytest.mark.slow
def test_eight_threads_at_once_give_the_same_bytes():
    # Two threads make the same pictures at the same time.
    names = 2 * ["pencil", "shadows", "cone", "three_bars"]

    def pictures(name: str) -> list[bytes]:
        scene = vp.read(ROOT / "data" / f"{name}.scene")
        image = vp.render(scene, size=(40, 30))
        return [write(vp.draw(scene), "svg"), write(vp.paint(scene, tolerance_mm=1.0), "pdf"), write(image, "png")]

    alone = 2 * [pictures(name) for name in names[:4]]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(pictures, names)) == alone
