"""How much tests try: what finds most at every change, and by hand much more (--hypothesis-profile=long).

The profile counts for what Hypothesis makes up and for views and samples that tests draw at random.
"""

from __future__ import annotations

from hypothesis import settings

USUAL, LONG = 25, 600
"""Examples of a property, in the profiles ci and long."""


def register_profiles() -> None:
    """ci: the same few examples on every run, for a failure that comes and goes teaches nothing; long: others on every
    run, and many."""
    settings.register_profile("ci", derandomize=True, deadline=None, max_examples=USUAL, database=None)
    settings.register_profile("long", deadline=None, max_examples=LONG)


def examples(count: int) -> int:
    """So many examples for each hundred of the property's own count, as the profile has of its own: a quarter in ci."""
    return max(6, count * settings().max_examples // 100)


def several(usual: int, *, long: int) -> int:
    """How many views or samples to draw at random."""
    return long if settings().max_examples >= LONG else usual
