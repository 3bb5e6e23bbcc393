"""Rough meshes in every verb, each in a process that may have two gigabytes of addresses and no more."""

from __future__ import annotations

import pytest
from support.rough import VERBS, made_in_two_gigabytes


@pytest.mark.slow
@pytest.mark.parametrize("verb", VERBS)
def test_meshes_of_twenty_thousand_triangles_in_two_gigabytes(verb: str) -> None:
    assert made_in_two_gigabytes(verb, 5) > 100_000
