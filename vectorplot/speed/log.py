"""What was measured, as a value and as a file."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.errors import InputError
from vectorplot.speed.operations import Operation

FORMAT, VERSION = "vectorplot-speed", 1


@dataclass(frozen=True)
class Measured:
    """What pictures of one kind cost: name, verb, and thing, what sizes count; for each of the sizes the seconds of the
    processor; stages of the largest one with their parts of its time; memory in MB that this one needed at most."""

    name: str
    verb: str
    thing: str
    sizes: tuple[int, ...]
    seconds: tuple[float, ...]
    stages: tuple[tuple[str, float], ...]
    memory_mb: float

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
