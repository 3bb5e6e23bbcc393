"""What was measured as tables, and two runs beside each other."""

from __future__ import annotations

from collections.abc import Sequence

from vectorplot.speed.log import Log
from vectorplot.speed.operations import Operation

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
    head = f"{'picture':<22} {'verb':<7} {'things':>20} {'s':>8} {'points':>8} {'growth':>7} {'MB':>6}  longest stages"
    rows = [head]
    for one in log.pictures:
        longest = sorted(one.stages, key=lambda stage: -stage[1])[:MOST_STAGES]
        stages = ", ".join(f"{name} {100.0 * part:.0f} %" for name, part in longest)
        things = f"{one.sizes[-1]:,} {_plural(one.thing)}"
        growth = f"{one.exponent:7.2f}" if len(one.sizes) > 1 else " " * 7
        points = one.points(log.point_us)
        rows.append(
            f"{one.name:<22} {one.verb:<7} {things:>20} {one.seconds[-1]:8.3f} {points:8.1f} {growth} "
            f"{one.memory_mb:6.0f}  {stages}"
        )
    return [
        *rows,
        "points: what one thing costs, in points projected and sorted; growth: the exponent of the time over the size",
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
