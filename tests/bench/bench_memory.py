"""Meshes of 80,000 and 330,000 triangles in every verb in two gigabytes: ``pytest tests/bench/bench_memory.py -s``."""

from __future__ import annotations

import pytest
from support.rough import VERBS, made_in_two_gigabytes

pytestmark = pytest.mark.bench


@pytest.mark.parametrize("halvings", [6, 7])
@pytest.mark.parametrize("verb", VERBS)
def test_rough_meshes_in_two_gigabytes(verb: str, halvings: int) -> None:
    assert made_in_two_gigabytes(verb, halvings) > 100_000
