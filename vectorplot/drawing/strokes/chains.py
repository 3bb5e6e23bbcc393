"""Chains of strokes that are linked end to end: who comes after whom, and which way round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Ints

NO_END = -1


@dataclass(frozen=True, eq=False)
class Chains:
    """Strokes in sequence. Stroke i has the ends 2i (its first point) and 2i + 1 (its last).

    entry (m,): the end at which each stroke is entered, chain after chain; offsets (c+1,): where the chains begin;
    cyclic (c,): the last stroke of the chain is linked to its first.
    """

    entry: Ints
    offsets: Ints
    cyclic: Bools


def chains(mate: Ints) -> Chains:
    """The chains that links between ends make.

    mate (2m,): the end each end is linked to, or NO_END; mate[mate[e]] == e. Chains come in the order of their smallest
    end among those at which they begin or end (a cycle: its smallest stroke, entered at its first point).
    """
    states = np.arange(len(mate), dtype=np.intp)
    # A state is the end at which a stroke is entered; it is left at the other one, which differs in the last bit.
    following = mate[states ^ 1]
    last, steps, on_cycle = _ranked(following, np.flatnonzero(following != NO_END))
    if on_cycle.any():
        head = _cycle_heads(following, np.flatnonzero(on_cycle))
        before_head = mate[head[head == states]] ^ 1
        cut = following.copy()
        cut[before_head] = NO_END
        ring_last, ring_steps, _ = _ranked(cut, np.flatnonzero(on_cycle & (cut != NO_END)))
        last, steps = np.where(on_cycle, ring_last, last), np.where(on_cycle, ring_steps, steps)
        keep = np.where(on_cycle, (head & 1) == 0, last ^ 1 > last[states ^ 1] ^ 1)
        chain = np.where(on_cycle, head, last[states ^ 1] ^ 1)
    else:
        keep = last ^ 1 > last[states ^ 1] ^ 1
        chain = last[states ^ 1] ^ 1
    states = states[keep]
    chain, steps, cyclic = chain[keep], steps[keep], on_cycle[keep]
    sizes = np.bincount(chain, minlength=len(mate))
    ends = np.cumsum(sizes)
    entry = np.zeros_like(states)
    entry[ends[chain] - 1 - steps] = states
    used = np.flatnonzero(sizes)
    flags = np.zeros(len(mate), dtype=np.bool_)
    flags[chain] = cyclic
    return Chains(entry, np.concatenate(([0], ends[used])).astype(np.intp), flags[used])


def _ranked(following: Ints, active: Ints) -> tuple[Ints, Ints, Bools]:
    """For every active state the last one of its chain, the steps to it, and whether it lies on a cycle.

    Source: Wyllie, The complexity of parallel computations (1979): list ranking by pointer jumping.
    """
    last = np.where(following == NO_END, np.arange(len(following)), following)
    steps = (following != NO_END).astype(np.intp)
    on_cycle = np.zeros(len(following), dtype=np.bool_)
    ended = following == NO_END
    while len(active):
        at = last[active]
        arrived = ended[at]
        if not arrived.any():
            on_cycle[active] = True
            break
        # All new values are computed from the old ones before any is stored.
        further, more = last[at], steps[active] + steps[at]
        last[active], steps[active] = further, more
        ended[active[arrived]] = True
        active = active[~arrived]
    return last, steps, on_cycle


def _cycle_heads(following: Ints, members: Ints) -> Ints:
    """For every state on a cycle the smallest state of the cycle; NO_END for the others."""
    head = np.full(len(following), NO_END, dtype=np.intp)
    head[members] = members
    jump = following.copy()
    while True:
        at = jump[members]
        smaller = np.minimum(head[members], head[at])
        if np.array_equal(smaller, head[members]):
            return head
        head[members] = smaller
        jump[members] = jump[at]
