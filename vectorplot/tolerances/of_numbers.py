"""Numbers that come from how doubles and singles are stored: their steps, and the ends of their range."""

from __future__ import annotations

ULP = 2.0**-52
"""The step of doubles at one: all rounding of doubles is counted in it."""

HALF_ULP = 2.0**-53
"""The largest relative error of one operation of doubles: the error bounds of orientation predicates are made of it."""

SINGLE_ULP = 2.0**-23
"""The step of singles at one: what a mesh file of single precision lets one know about its corners."""

ROUNDING = 16.0 * ULP
"""What a few additions and multiplications of doubles may lose, relative to the largest number among them: each loses
half a step, and a cross product of differences has about a dozen of them one after the other."""

COMPUTED = 2.0**-44
"""What coordinates that a program computed may be off, relative to the largest of them: sines and sums of sines lose a
few steps, a seam closes where ends differ by no more."""

ROUNDING_OF_TERMS = 4.0 * ULP
"""What a single sum of a few terms may lose, relative to the largest of its terms: a value no larger is zero."""

BRACKET_USED_UP = 4e-16
"""A bracket of a zero within [0, 1] that is no wider holds hardly a double between its ends: nothing is to be
halved."""

SINGLE_BOX_SHARE, SINGLE_BOX_LEAST = 3e-7, 1e-7
"""Boxes in single precision grow by so much, relative to their coordinates, and by so much of the scene, which is about
1 large: a little more than two steps of singles, so that rounding never moves a face out of its box."""

SINGLE_LINE_SHARE = 1e-6
"""A line in the image, in single precision, moves outwards by so much of the largest of its terms: three times what
the rounding of its coefficients, of a point and of their products may come to."""

SINGLE_DEPTH_SHARE, SINGLE_DEPTH_LEAST = 2e-7, 1e-7
"""Largest depths in single precision are moved away by so much, relative and of the scene: more than one step of
singles, so that rounding never moves an occluder in front of what it is behind."""

COSINE_OF_SINGLES = 1e-5
"""Slack of a comparison of cosines of unit normals in single precision: a hundred times their rounding, and still only
a first sieve; what passes is looked at in doubles."""

LEAST_DIVISOR = 1e-300
"""A length or a size is divided by this at least: what is zero divided by itself becomes zero, not undefined. Far below
every length that occurs, and its reciprocal still is a number."""

UNDERFLOW = 1e-280
"""Below it products of doubles may have lost digits that the error bounds of predicates do not know of."""

SMALLEST_OF_SINGLES, LARGEST_OF_SINGLES = 1e-30, 1e30
"""Values are put between these before they become singles: so every sign survives."""

COMPLEX_STEP = 1e-30
"""Part of the domain that the imaginary part of a parameter is, for derivatives without a difference: so small that its
square vanishes beside one, and nothing is subtracted that could lose digits."""

LARGEST = 1e60
"""Numbers in files beyond this, and extents below its reciprocal, are refused: fifth powers still are numbers."""

LARGEST_VIEW = 1e100
"""Scenes larger than this, or smaller than its reciprocal, are not looked at: products of three lengths still are
numbers."""

INFINITE = float("inf")
"""Where parallel lines meet, and how far away the centre of a parallel projection is."""

NEGLIGIBLE_PART = 1e-6
"""Regions that differ in so small a part of their area are the same: where they were cut on a grid digits are gone."""

ONE_SURFACE = 1e-9
"""Surfaces that are no farther apart than this part of their extent are in one place: where they are turned digits are
gone, and steps to a point end a few digits before the last."""
