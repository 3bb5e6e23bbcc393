"""What must hold whatever the input: one line or a result, within seconds and megabytes that follow its size."""

from __future__ import annotations

import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from fuzz.fuzz_drawings import drawing_bytes
from fuzz.fuzz_meshes import MESHES, mesh_bytes
from fuzz.fuzz_molecules import MOLECULES, molecule_bytes
from fuzz.fuzz_scenes import formula_text, scene_bytes
from support.pace import TooLong, cpu_seconds

import vectorplot as vp
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.description import describe
from vectorplot.io.expressions import parse_expression
from vectorplot.io.read_file import read

READ_S, READ_S_A_MB = 2.0, 60.0
"""Reading takes no more CPU seconds than this, and so many more for a megabyte."""

VERB_S = 30.0
"""A verb takes no more CPU seconds than this on a scene of a few small items."""


@dataclass(frozen=True)
class Finding:
    """What went wrong: in short, by which findings are told apart, and the whole story."""

    cause: str
    story: str


def finding(work: Callable[[], object], seconds: float) -> Finding | None:
    """What is wrong with some work: an error that is no InputError of one printable line, a warning of another library,
    a text that could steer a terminal, or too long a time. None: nothing."""
    try:
        with warnings.catch_warnings(record=True) as caught, cpu_seconds(seconds):
            warnings.simplefilter("error")
            warnings.simplefilter("always", InputWarning)
            work()
    except InputError as error:
        if not str(error).isprintable():
            return Finding("an error that is no line of letters", repr(str(error)))
        if len(str(error)) > 6000:
            return Finding("a long line", str(error))
    except TooLong:
        return Finding("too long: " + _place(traceback.format_exc()), traceback.format_exc())
    except Exception as error:
        return Finding(f"{type(error).__name__}: " + _place(traceback.format_exc()), traceback.format_exc())
    for entry in caught:
        if not str(entry.message).isprintable():
            return Finding("a warning that is no line of letters", repr(str(entry.message)))
    return None


def _place(story: str) -> str:
    """The innermost place in the package, and the last line."""
    lines = story.splitlines()
    own = [line.strip() for line in lines if "/vectorplot/" in line and line.lstrip().startswith("File")]
    return f"{own[-1].rpartition('/vectorplot/')[2] if own else '?'}: {lines[-1][:120]}"


def described(path: Path) -> None:
    """Read a file and describe it, as info does, in lines that show."""
    for line in describe(read(path)):
        if "\n" in line:
            raise AssertionError(f"not one line: {line!r}")


def drawn(path: Path) -> None:
    """Draw a file on a small page, and write it."""
    scene = read(path)
    vp.save(vp.draw(scene, page=vp.Page(60.0, 60.0, 5.0), tolerance_mm=0.2), path.with_suffix(".svg"))


def painted(path: Path) -> None:
    """Paint a file on a small page, and write it."""
    scene = read(path)
    vp.save(vp.paint(scene, page=vp.Page(60.0, 60.0, 5.0), tolerance_mm=0.2), path.with_suffix(".svg"))


def rendered(path: Path) -> None:
    """Render a file in few pixels, and write it."""
    vp.save(vp.render(read(path), size=(40, 40)), path.with_suffix(".png"))


def read_back(path: Path) -> None:
    """Read a drawing, and write it."""
    vp.save(vp.read(path), path.with_suffix(".svg"))


VERBS: dict[str, Callable[[Path], None]] = {"info": described, "draw": drawn, "paint": painted, "render": rendered}
"""What is done with whole files, by name."""

FILES = (*MESHES, *MOLECULES, "scene", "json")
"""The kinds of files that are read, by suffix."""

TARGETS = (*FILES, "formula", *VERBS)
"""Everything that a campaign attacks: the readers of all formats, the reader of formulas, and the verbs."""


def attack(target: str, seed: str, folder: Path) -> tuple[Finding | None, bytes, str, float]:
    """What one input, made of a seed, finds in a target; the input, the suffix of its file, and the CPU seconds."""
    rng = Random(seed)
    if target == "formula":
        data, suffix = formula_text(rng).encode("utf-8", "surrogatepass"), "txt"
    elif target in MESHES:
        data, suffix = mesh_bytes(rng, target), target
    elif target in MOLECULES:
        data, suffix = molecule_bytes(rng, target), target
    elif target == "json":
        data, suffix = drawing_bytes(rng), "json"
    elif target == "scene":
        data, suffix = scene_bytes(rng), "scene"
    elif rng.random() < 0.2:
        suffix = rng.choice(list(MESHES))
        data = mesh_bytes(rng, suffix)
    else:
        data, suffix = scene_bytes(rng, 0.1 if target == "paint" else 0.25), "scene"
    start = time.process_time()
    found = judged(target, data, suffix, folder)
    return found, data, suffix, time.process_time() - start


def judged(target: str, data: bytes, suffix: str, folder: Path) -> Finding | None:
    """What is wrong with what a target does with the bytes of a file."""
    reading = READ_S + READ_S_A_MB * len(data) / 1e6
    if target == "formula":
        return finding(lambda: _used(data.decode("utf-8", "surrogatepass")), reading)
    path = folder / f"input.{suffix}"
    # To write over a file makes some file systems wait for the disk.
    path.unlink(missing_ok=True)
    path.write_bytes(data)
    if target == "json":
        return finding(lambda: read_back(path), reading)
    return finding(lambda: VERBS.get(target, read)(path), reading + VERB_S * (target in VERBS and target != "info"))


def _used(text: str) -> None:
    """A formula read, evaluated, and derived twice."""
    expression = parse_expression(text, ("x", "y"))
    expression(x=0.5, y=-1.0)
    if len(expression.nodes) < 60:
        expression.derivative("x").derivative("y")(x=[0.0, 2.0], y=1.0)


def attacks(target: str, seeds: Iterator[str]) -> Iterator[tuple[str, Finding | None, bytes, str, float]]:
    """The attacks on a target with some seeds, each with its seed."""
    with TemporaryDirectory() as folder:
        for seed in seeds:
            yield seed, *attack(target, seed, Path(folder))
