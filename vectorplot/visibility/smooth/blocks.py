"""Rows taken in blocks whose partners fit into memory, until the budget is used up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from vectorplot.arrays import Ints

T = TypeVar("T")

FIRST, FASTER = 32, 8
"""Rows of the first block, at least: how many partners rows have is not known yet; and so many times as many rows as in
a block there may be in the next one."""

AT_ONCE = 1 << 18
"""Partners of a block, about."""

EACH = 1 << 14
"""The part of the budget's pairs that every row may have, if that is more in all: scenes of many lines have many."""


@dataclass(frozen=True, eq=False)
class Block(Generic[T]):
    """What was found for a block of rows; partners: how many were held in memory; close: how many of these called for
    close work."""

    found: T
    partners: int
    close: int


def in_blocks(rows: Ints, pairs: int, partners: int, look: Callable[[Ints], Block[T]]) -> tuple[list[T], int]:
    """What look finds for one block of rows (k,) after the other, and how many of the rows were looked at before more
    than the budget's pairs had called for close work. partners: no row has more."""
    found: list[T] = []
    done, size, close = 0, max(FIRST, min(AT_ONCE, pairs) // max(partners, 1)), 0
    most = max(pairs, len(rows) * (pairs // EACH))
    while done < len(rows) and close <= most:
        block = look(rows[done : done + size])
        found.append(block.found)
        done = min(done + size, len(rows))
        close += block.close
        # The next block may have more partners than this one had: it grows slowly.
        size = max(1, min(FASTER * size, int(size * min(AT_ONCE, most) / max(block.partners, 1))))
    return found, done
