"""Lengths as parts of other lengths: of a chord, a cell, a stroke, a tolerance, a step."""

from __future__ import annotations

FIT_OF_TOLERANCE = 1e-3
"""Errors of fitted segments below this part of the tolerance are equal: which of them is joined first does not
matter."""

ARC_OF_TOLERANCE = 1e-3
"""An arc of an ellipse is one only if all points agree within this part of the tolerance: what was an arc agrees to
rounding, and what merely resembles one does not."""

CUBIC_OF_TOLERANCE = 1e-4
"""Neighbouring Bézier curves that are exact become one where all control points agree within this part of the
tolerance: those of one polynomial do to rounding."""

COVERED_OF_TOLERANCE = 1e-3
"""A piece of a line that another one leaves uncovered is real if it is longer than this part of the tolerance."""

ACCURACY_OF_TOLERANCE = 1e-3
"""Distances of curves are computed to this part of the tolerance that they are compared with."""

LENGTH_SETTLED = 1e-13
"""Part of the length of a path by which it and its halves may differ where no further halving is needed."""

SUM_OF_LENGTHS = 1e-12
"""Part of a stroke's length that rounding of the sum of its steps may add."""

SLACK_OF_LENGTH = 1e-11
"""Part of a line's length by which places along it are kept apart from their own neighbours: more than the sum of its
steps loses."""

BESIDE_LINE = 1e-3
"""Part of the way from a singular line of a surface to the middle of its neighbours at which a sheet is looked at that
ends there: near enough for any page, and far enough that its normal is no rounding."""

COLLINEAR_OF_LENGTH = 1e-3
"""A stroke lies along another only within this part of the shorter one's length too: a short one has no direction
else."""

NARROW_OF_LENGTH = 1e-6
"""Triangles narrower than this part of their length have colours along it only: across, a gradient is rounding."""

THIN_OF_LENGTH = 1e-10
"""Below this ratio of height to longest side a triangle has no direction any more; one of 1 to 100 million still
has."""

NO_AREA = 1e-9
"""An ear of less area, as a part of its longest side squared, is none: its corner is straight but for rounding, and no
ray can say whether it meets it."""

WIDE_OF_AREA = 1e-3
"""Triangles with less than this part of the usual area are slivers: that a condition holds at their corners says
nothing about an area."""

MERGED_OF_CELL = 1e-6
"""Vertices closer than this part of a cell are one: a surface that passes a grid point so closely passes through it."""

ONE_CONTACT_OF_CELL = 1e-3
"""Contacts of two surfaces closer than this part of a cell are one: touching, each is known to the root of the
rounding."""

CONTACT_FOUND_OF_CELL = 1e-7
"""A contact has been found when a step to it is shorter than this part of a cell: touching loses half the digits."""

CONTACT_SETTLED_OF_CELL = 1e-10
"""The same when no further step is taken."""

ON_BORDER_OF_CELL = 1e-4
"""Cells from a border within which a place where curves are joined is on it."""

NODE_SETTLED_OF_CELL = 1e-9
"""Critical points that a step moves by less than this part of a cell have been found."""

BEYOND_END = 1e-9
"""So many lengths of a piece beyond its end count as the end: a root that rounding has moved out still is its own."""

BESIDE_POLE = 1e-3
"""Part of a piece that one goes along it from a pole, where there is no curvature, to where there is one."""

SAME_EVENT = 1e-6
"""Parts of a chord that differ by less are one event: where curves touch, places are known to the root of the
rounding."""

CROSSING_SETTLED = 1e-10
"""Newton's next step to a crossing after one of this part of a chord is rounding."""

RESIDUAL_OF_GAP = 1e-3
"""Part of the cube of the gap that the residual of a crossing may be: two curves that touch come as close as they like,
but not at a distance."""

MODEL_RESIDUAL_OF_GAP = 1e-3
"""The same for cubic arcs, as a part of the square of the gap: towards a place where two curves touch they come
together like the square of what is left of the gap."""

FAMILY_SETTLED = 1e-9
"""The step of Newton after one of this part of a chord is rounding where contours of families of sheets are refined."""

MISSED_OF_CHORD = 1e-6
"""Where two sheets, or the last two steps, are still apart by this part of a chord the sheets do not cross, but touch,
as in a pinch point: there the first one has to do."""

SMALLEST_STEP_SHARE = 1e-3
"""Where no larger part of a step of Newton leads a refracted ray nearer, nothing does."""

UNION_OF_SEGMENT = 1e-9
"""Hidden parts of a segment less than this part of it apart are one: what is left between them is rounding."""

LEAST_GAIN_OF_TRAVEL = 1e-3
"""A round of moves that makes a long tour of the pen shorter by less than this part is its last one: those that follow
gain less still, and each costs as much as a tenth of the whole order."""

LEAST_TOLERANCE_MM = 1e-6
"""A thousandth of the last digit of the files: who asks for a finer one has missed a power of ten."""
