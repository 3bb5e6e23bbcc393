"""What could not be decided of curves f = 0, in words."""

from __future__ import annotations

from collections.abc import Sequence

from vectorplot.geometry.budget import unresolved

JUMPS = "f changes its sign without being zero"
"""How the doubt about poles and jumps of f begins."""


EVERYWHERE = "f is zero all over its domain, which is no curve"
"""The doubt about f that is nothing but zero."""


def doubts_of_one(
    flat: int, cells: int, found: Sequence[int], complete: bool, unsure: int, enough: bool, tangled: float
) -> tuple[str, ...]:
    """What could not be decided of one function, a sentence each; flat: cells, of so many, in which it is
    zero; found: a row of the counts of what was found."""
    poles, missed, beads, touching = found
    line = touching - beads
    texts = [
        (flat == cells, EVERYWHERE),
        (0 < flat < cells, f"f is zero all over {flat} cells: only the border towards negative values is a curve"),
        (poles > 0, f"{JUMPS} at {poles} places: poles or jumps, not part of the curve"),
        (
            tangled > 0.0,
            f"curves that wind more finely than the resolution are left out in {100.0 * tangled:.1g} % of the domain",
        ),
        (not complete, unresolved("branches of a curve are too small or too many")),
        (not enough, unresolved("curves are off by more than the tolerance")),
        (unsure > 0, f"{unsure} chords may be off by more than the tolerance: the curve was not found beside them"),
        (missed > 0, "closed branches smaller than the resolution are missing: ask for a finer one"),
        (
            beads > 0,
            "branches nearer to each other than the resolution are given as points of them; ask for a finer one",
        ),
        (line > 0, "f touches zero along a line without changing its sign: points of it are given, no curve"),
    ]
    return tuple(text for said, text in texts if said)
