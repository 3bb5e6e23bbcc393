"""The numbers that say when something counts as zero, parallel or infinitely far: here and nowhere else.

All of them are relative; what they are multiplied with stands where they are used.
Source: Glaeser, sections 1.1 and 3.1 (central constants); errata G1-03, G1-06.
"""

from __future__ import annotations

ZERO_OF_EXTENT = 1e-9
"""A distance below this part of the extent of what is looked at counts as zero."""

PARALLEL_SINE = 1e-12
"""Directions that enclose an angle with a smaller sine count as parallel."""

ROUNDING = 16.0 * 2.0**-52
"""What a few additions and multiplications of doubles may lose, relative to the largest number among them."""

INFINITE = float("inf")
"""Where parallel lines meet, and how far away the centre of a parallel projection is."""

LARGEST = 1e60
"""Numbers in files beyond this, and extents below its reciprocal, are refused: fifth powers still are numbers."""
