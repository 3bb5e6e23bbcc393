"""How well errors are measured: what truth is made of, and down to where approximations are tried."""

from __future__ import annotations

FINEST_FIT_MM = 1e-3
"""The smallest tolerance that fits of curves are tried with: a twentieth of the usual one."""

FINEST_ARC_MM = 1e-5
"""The smallest tolerance that circles are tried with as segments: what files of a hundred digits could tell."""

FINEST_STROKE_MM = 1e-3
"""The smallest tolerance that drawings are tried with: the last digit of an SVG file."""

FINEST_OF_EXTENT = 1e-13
"""The smallest part of the extent that integral curves are tried with as their accuracy: below it, all is rounding."""

PART_OF_FINEST = 1e-2
"""Chords by which errors are measured are within this part of the smallest tolerance of their curves."""

TRUE_ISOPHOTE_MM = 1e-6
"""How near the chords of the isophote that points are compared with are to it, on the page: less than the smallest
error that is measured there."""

TRUE_CONTOUR = 1e-6
"""How near the chords of true contours are to them, in units of the world, of which a page has some eight: a tenth of
the smallest error that is measured against them."""

CONTOUR_ACCURACY_MM = 1e-5
"""Distances between contours of meshes and true ones are taken so well: a thousandth of the smallest of them."""

OUTLINE_ACCURACY_MM = 1e-4
"""The same of outlines of painted surfaces, which are never better than hundredths of a millimetre."""

ON_STROKE_MM = 1e-3
"""A place so near to a visible stroke is drawn: less than half the length of a piece that is asked for, and more than
chords are off."""

OWN_MEETING = 1e-9
"""A meeting of a sight line with the torus so near to the point that it starts from, in units of the world, is the
point itself: roots of the cubic are known better."""

VERTEX_NOISE_OF_EXTENT = 1e-10
"""How far vertices are moved to see what counts as zero: what modellers leave behind after some steps in doubles."""

SMALLEST_ZERO = 1e-16
"""The smallest part of half the extent that is tried as what counts as zero: less than rounding."""

ROUND_OF_RADIUS = 1e-3
"""A ring of edges whose vertices are off a circle by no more than this part of its radius is one: files of single
precision and the rounding of programs that make them are finer, polygons that are not meant round far coarser."""

PLAIN_NUMBER = 1e-3
"""Smaller numbers stand at an axis as powers of ten."""
