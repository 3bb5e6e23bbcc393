"""Time and memory measured: single operations, and results as files, drawings, tables and comparisons."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.drawing.charts import Curve, Panel, chart
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.pictures.pipeline import peak_mb

# Time of the processor, and memory, that something takes.

_RESET = Path("/proc/self/clear_refs")
"""Where Linux forgets the peak of a process's memory so far."""


def cpu_seconds(action: Callable[[], object], repeat: int = 3) -> float:
    """The shortest of a few times, of the processor: those of other programs do not count."""
    return _shortest(action, repeat, time.process_time)


def wall_seconds(action: Callable[[], object], repeat: int = 3) -> float:
    """The shortest of a few times, of the clock: what several threads do at once counts once."""
    return _shortest(action, repeat, time.perf_counter)


def _shortest(action: Callable[[], object], repeat: int, clock: Callable[[], float]) -> float:
    times = []
    for _ in range(repeat):
        start = clock()
        action()
        times.append(clock() - start)
    return min(times)


def peak_of(action: Callable[[], object]) -> float:
    """The memory in MB that something needed at most beyond what there was; where the system does not forget earlier
    peaks, beyond these."""
    try:
        _RESET.write_text("5")
    except OSError:
        pass
    before = peak_mb()
    action()
    return peak_mb() - before


# What single operations cost: of numbers in arrays, and of calls in Python.

COUNT = 1 << 18
"""So many numbers an array has: it stays in the processor's cache."""

CALLS = 50_000


@dataclass(frozen=True)
class Operation:
    """An operation and its cost: microseconds for one of them."""

    name: str
    microseconds: float


@dataclass(frozen=True)
class _Pair:
    x: float
    y: float

    def __add__(self, other: _Pair) -> _Pair:
        return _Pair(self.x + other.x, self.y + other.y)

    def total(self) -> float:
        return self.x + self.y


def array_operations() -> tuple[Operation, ...]:
    """Additions of bytes, integers and floats, and what all stages do most: multiply, divide, compare, gather, sort."""
    rng = np.random.default_rng(1)
    floats, other, index = rng.uniform(1.0, 2.0, COUNT), rng.uniform(1.0, 2.0, COUNT), rng.permutation(COUNT)
    every: list[tuple[str, Callable[[], object]]] = []
    for name, kind in (("float", np.float64), ("long", np.int64), ("int", np.int32), ("byte", np.int8)):
        a, b = floats.astype(kind), other.astype(kind)
        every.append((f"add {name}s", partial(np.add, a, b)))
    every += [
        ("multiply floats", lambda: floats * other),
        ("divide floats", lambda: floats / other),
        ("compare floats", lambda: floats < other),
        ("gather floats", lambda: floats[index]),
        ("sort longs", lambda: np.sort(index)),
        ("sort floats by index", lambda: np.argsort(floats, kind="stable")),
    ]
    return tuple(Operation(name, 1e6 * cpu_seconds(action, 7) / COUNT) for name, action in every)


def call_operations() -> tuple[Operation, ...]:
    """One sum in Python: written out, in functions that take numbers, a tuple or a record, as operator and method."""
    one, two = _Pair(1.0, 2.0), _Pair(3.0, 4.0)
    x, y = np.float64(1.0), np.float64(2.0)

    def by_value(a: float, b: float) -> float:
        return a + b

    def by_reference(pair: Sequence[float]) -> float:
        return pair[0] + pair[1]

    def by_record(pair: _Pair) -> float:
        return pair.x + pair.y

    couple = (1.0, 2.0)
    every: list[tuple[str, Callable[[], object]]] = [
        ("written out", lambda: [1.0 + k for k in range(CALLS)]),
        ("function of numbers", lambda: [by_value(1.0, k) for k in range(CALLS)]),
        ("function of a tuple", lambda: [by_reference(couple) for _ in range(CALLS)]),
        ("function of a record", lambda: [by_record(one) for _ in range(CALLS)]),
        ("method of a record", lambda: [one.total() for _ in range(CALLS)]),
        ("operator of records", lambda: [one + two for _ in range(CALLS)]),
        ("numpy of two numbers", lambda: [np.add(x, y) for _ in range(CALLS)]),
    ]
    return tuple(Operation(name, 1e6 * cpu_seconds(action) / CALLS) for name, action in every)


def point_cost() -> float:
    """What the bare work on a point costs, in microseconds: project it and put it in its place from front to back.

    Of this nothing that shows a scene can be spared; what pictures cost is told in it, so that machines do not matter.
    """
    rng = np.random.default_rng(2)
    points, axes = rng.normal(size=(3, COUNT)), rng.normal(size=(3, 3))

    def project() -> object:
        x, y, z = matmul(axes, points)
        z += 10.0
        return x / z, y / z, np.argsort(z, kind="stable")

    return 1e6 * cpu_seconds(project, 7) / COUNT


# What was measured, as a value and as a file.

FORMAT, VERSION = "vectorplot-speed", 1


@dataclass(frozen=True)
class Measured:
    """What pictures of one kind cost: name, verb, and thing, what sizes count; for each of the sizes the seconds of the
    processor; stages of the largest one with their parts of its time; memory in MB that this one needed at most; its
    file, SVG or PNG, in MB (0 in logs of earlier versions)."""

    name: str
    verb: str
    thing: str
    sizes: tuple[int, ...]
    seconds: tuple[float, ...]
    stages: tuple[tuple[str, float], ...]
    memory_mb: float
    file_mb: float = 0.0

    @property
    def exponent(self) -> float:
        """How the time grows with the size: by its power with this exponent, the best fit over all sizes."""
        return float(np.polyfit(np.log(self.sizes), np.log(self.seconds), 1)[0])

    def points(self, point_us: float) -> float:
        """What one thing of the largest picture costs, in points projected and sorted at so many microseconds each."""
        return 1e6 * self.seconds[-1] / self.sizes[-1] / point_us


@dataclass(frozen=True)
class Threads:
    """Seconds of the clock that a picture takes on one thread, and on so many."""

    name: str
    size: int
    threads: int
    one: float
    several: float


@dataclass(frozen=True)
class Log:
    """All that one run measured: machine, what it ran on; operations in arrays and calls in Python; point_us: the bare
    cost of a point in microseconds; pictures; and threads."""

    machine: str
    operations: tuple[Operation, ...]
    calls: tuple[Operation, ...]
    point_us: float
    pictures: tuple[Measured, ...]
    threads: tuple[Threads, ...]


def write_log(log: Log, path: str) -> None:
    """Write a log as JSON."""
    document = {"format": FORMAT, "version": VERSION, **asdict(log)}
    Path(path).write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def read_log(path: str) -> Log:
    """The log in a file. Errors: InputError, with the file's name, for a file that is none."""
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
        if document["format"] != FORMAT or document["version"] != VERSION:
            raise InputError(f"{path}: no log of vectorplot speed of version {VERSION}")
        return _log(document)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: no log of vectorplot speed") from None


def _log(document: dict[str, Any]) -> Log:
    return Log(
        str(document["machine"]),
        tuple(Operation(**entry) for entry in document["operations"]),
        tuple(Operation(**entry) for entry in document["calls"]),
        float(document["point_us"]),
        tuple(_measured(entry) for entry in document["pictures"]),
        tuple(Threads(**entry) for entry in document["threads"]),
    )


def _measured(entry: dict[str, Any]) -> Measured:
    lists = {name: tuple(entry[name]) for name in ("sizes", "seconds")}
    stages = tuple((str(name), float(part)) for name, part in entry["stages"])
    return Measured(**{**entry, **lists, "stages": stages})


# What was measured as a drawing: time over size, and what one thing costs.


def plot(log: Log, before: Log | None = None) -> Drawing:
    """The seconds of all pictures over their sizes, and what one thing costs in points, with an earlier log dashed."""
    numbers = {one.name: number for number, one in enumerate(log.pictures)}
    seconds = [Curve(one.name, one.sizes, one.seconds, numbers[one.name]) for one in log.pictures]
    points = [Curve(one.name, one.sizes, _points(one, log), numbers[one.name]) for one in log.pictures]
    if before is not None:
        known = [one for one in before.pictures if one.name in numbers]
        seconds += [_dashed(one, one.seconds, numbers[one.name]) for one in known]
        points += [_dashed(one, _points(one, before), numbers[one.name]) for one in known]
    panels = (
        Panel("things", "seconds", tuple(seconds)),
        Panel("things", "points projected and sorted, for each", tuple(points)),
    )
    return chart("speed", panels, "dashed: before" if before is not None else "")


def _points(one: Measured, log: Log) -> tuple[float, ...]:
    """What one thing costs at each size, in points projected and sorted."""
    return tuple(1e6 * s / n / log.point_us for s, n in zip(one.seconds, one.sizes, strict=True))


def _dashed(one: Measured, values: tuple[float, ...], number: int) -> Curve:
    return Curve(one.name, (one.sizes[0], one.sizes[-1]), (values[0], values[-1]), number, marked=False, dashed=True)


# What was measured as tables, and two runs beside each other.

FASTER, SLOWER = 0.9, 1.1
"""What takes less, or more, than this part of the time before is said to be faster or slower; the rest is noise."""

MOST_STAGES = 3
"""So many stages are named, the longest first."""


def tables(log: Log) -> str:
    """A log as text."""
    parts = [log.machine, "", *_operations("numbers in arrays", log.operations)]
    parts += ["", *_operations("a sum in Python", log.calls)]
    parts += ["", f"a point projected and sorted: {log.point_us:.3f} microseconds", "", *_pictures(log)]
    if log.threads:
        parts += ["", *_threads(log)]
    return "\n".join(parts)


def _operations(title: str, operations: Sequence[Operation]) -> list[str]:
    """The first one is a hundred per cent."""
    base = operations[0].microseconds if operations else 1.0
    rows = [f"{o.name:<24} {o.microseconds:10.5f} {100.0 * o.microseconds / base:7.0f}" for o in operations]
    return [f"{title:<24} {'us':>10} {'%':>7}", *rows]


def _pictures(log: Log) -> list[str]:
    head = f"{'picture':<22} {'verb':<7} {'things':>20} {'s':>8} {'points':>8} {'growth':>7} {'MB':>6} {'file':>6}"
    rows = [f"{head}  longest stages"]
    for one in log.pictures:
        longest = sorted(one.stages, key=lambda stage: -stage[1])[:MOST_STAGES]
        stages = ", ".join(f"{name} {100.0 * part:.0f} %" for name, part in longest)
        things = f"{one.sizes[-1]:,} {_plural(one.thing)}"
        growth = f"{one.exponent:7.2f}" if len(one.sizes) > 1 else " " * 7
        points = one.points(log.point_us)
        rows.append(
            f"{one.name:<22} {one.verb:<7} {things:>20} {one.seconds[-1]:8.3f} {points:8.1f} {growth} "
            f"{one.memory_mb:6.0f} {one.file_mb:6.2f}  {stages}"
        )
    return [
        *rows,
        "points: what one thing costs, in points projected and sorted; growth: the exponent of the time over the size;",
        "MB: of memory; file: MB of SVG or PNG",
    ]


def _plural(thing: str) -> str:
    return {"box": "boxes", "torus": "tori"}.get(thing, f"{thing}s")


def _threads(log: Log) -> list[str]:
    rows = [f"{'on threads':<22} {'one s':>8} {'all s':>8} {'times':>6}"]
    for one in log.threads:
        rows.append(f"{one.name:<22} {one.one:8.3f} {one.several:8.3f} {one.one / one.several:6.2f}")
    return rows


def comparison(before: Log, now: Log) -> str:
    """Two logs beside each other: what each picture that both have costs in points, before and now."""
    rows = [f"{'points a thing':<22} {'before':>9} {'now':>9} {'now/before':>11}"]
    earlier = {one.name: one for one in before.pictures}
    for one in now.pictures:
        other = earlier.get(one.name)
        if other is None or other.sizes != one.sizes:
            rows.append(f"{one.name:<22} {'':>9} {one.points(now.point_us):9.1f}")
            continue
        was, is_ = other.points(before.point_us), one.points(now.point_us)
        word = "faster" if is_ < FASTER * was else "slower" if is_ > SLOWER * was else ""
        rows.append(f"{one.name:<22} {was:9.1f} {is_:9.1f} {is_ / was:11.2f}  {word}".rstrip())
    return "\n".join(rows)
