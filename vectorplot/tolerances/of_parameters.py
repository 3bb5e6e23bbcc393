"""Parts of a surface's domain, of a box, or of a curve's range of parameters."""

from __future__ import annotations

ROUNDING_OF_DOMAIN = 1e-12
"""A place this part of the domain away from a border, or from another place, is there: some thousand roundings of
parameters, and no visible step."""

ON_BORDER_OF_DOMAIN = 1e-9
"""An end of a curve this part of the domain away from a border or a seam is on it: ends are computed, not given."""

OUTSIDE_DOMAIN = 1e-9
"""Part of the domain, or of the box of an implicit surface, that a place may be outside of it and still belongs to
it."""

REPEATED_OF_DOMAIN = 1e-9
"""Points of a curve this part of the domain apart repeat each other: one of them goes."""

DOT_OF_DOMAIN = 1e-8
"""A curve no longer than this part of the domain is one point: it has no more than ten points that differ."""

JUMP_OF_DOMAIN = 1e-8
"""Part of the domain over which positions jump where they are farther apart than the tolerance: on the way there parts
of the domain were cut by three at least fifteen times."""

APART_OF_DOMAIN = 1e-3
"""Where a sheet meets itself, parts of its domain that the two places are apart at least: nearer ones are one place."""

CONTACT_PLACES = 1e-3
"""From a contour, meetings at places nearer to its own than this part of the domain are the contour itself."""

ONE_MEETING_PLACES = 1e-4
"""Meetings of a sight line whose places are farther apart than this part of the domain are two, however near in
space."""

RESOLUTION = 1e-3
"""Loops and gaps larger than this part of the domain, or of the box, are found where nothing else is asked for: a fifth
of a millimetre where the shape fills a sheet of paper."""

FIRST_DIFFERENCE = 2.0**-17
"""Part of the domain that a first difference spans: about the third root of the rounding, where rounding and curvature
spoil a difference equally."""

SECOND_DIFFERENCE = 2.0**-12
"""Part of the domain that a second difference spans: about the fourth root of the rounding, for the same reason."""

CURVATURE_DIFFERENCE = 2.0**-16
"""Part of the domain that a difference of curvatures spans: only the speed of Newton's method depends on it."""

CENTRAL_DIFFERENCE = 6e-6
"""Step of a central difference, relative to 1 + |x|: the third root of the rounding."""

BORDER_SEEN_FROM = 1e-7
"""Part of the domain by which a border that is a single point of the surface is looked at from inside."""

RIM_SEEN_FROM = 1e-9
"""Part of the domain by which the rim of a hole is looked at from inside: a surface that ends with a vertical tangent,
as a square root does, has no normal on it; so near it is off the rim by the root of that, less than is drawn."""

RIM_FOUND_TO = 1e-12
"""Part of the domain to which the rim of a hole is found: a thousandth of what it is looked at from inside by."""

AROUND_RIM = 1e-6
"""Part of the domain by which it is tried out on which side of the rim of a hole a surface lies."""

TURNED_OVER = 1e-7
"""Twice the area of a triangle in a domain, as a part of its longest side squared, that counts as none: places on a
rim are inside of it by some 1e-9 of the domain, more of the sides of small triangles."""

OFF_RIM = 1e-3
"""Part of the domain by which curvatures are looked at from inside of the rim of a hole: differences reach as far."""

ASIDE_OF_POLE = 1e-6
"""Part of the domain by which a pole is looked at from inside where the normal's derivatives are asked for: the
rounding of a cross product as small as that is no larger than what the normal turns on the way."""

ASIDE_OF_CREASE = 1e-6
"""Part of the side of a triangle by which an end on a sharp edge is looked at from inside: normals turn by no more than
that on the way, and the parameter is another one unless the side is lost in rounding anyway."""

CUSP_FOUND = 1e-7
"""A cusp has been found when the last step to it is shorter than this part of the domain: curvatures are
differences."""

CUSP_SETTLED = 1e-15
"""The same when no further step can help."""

PLACE_SETTLED = 1e-13
"""Steps in cells of a grid to the end of a double curve that are shorter are rounding."""

CUBIC_SETTLED = 1e-14
"""The zero of a cubic parabola in [0, 1] is known to this: some fifty roundings."""

NEWTON_SETTLED = 1e-12
"""Newton's method has settled, and bisection ends, at a change of this, relative to 1 + |x| or to the first bracket."""

FIRST_GUESS = 1e-3
"""A first guess of a zero in a bracket needs no more than this part of it: better methods take over from there."""

FOOT_SETTLED, FOOT_NO_BETTER = 1e-15, 1e-9
"""Steps to the foot of a point that are shorter than the first part of the domain are rounding; so are those shorter
than the second that lead no nearer."""

FIRST_DAMPING, LEAST_DAMPING = 1e-3, 1e-16
"""Damping of the search for a foot at its first step, and where none is left."""

IN_TRIANGLE = 1e-12
"""Barycentric coordinates that are less than zero by no more are those of a point on the side of a triangle."""

ABOVE_WHOLE = 1e-9
"""A number of parts no farther above a whole number counts as it: otherwise rounding would ask for one part more."""

JUST_BEFORE = 1e-9
"""Places along a line this part of a span before a point are taken for it: so rounding does not skip a point."""

BESIDE_STANDSTILL = 1e-3
"""So far inside of a chord, as a part of it, directions are taken that have a limit only at its end, and at twice and
three times as much: the third power of it is the error, and differences keep most of their digits."""

LEAST_PART = 1e-9
"""A shorter part of a chord is what rounding leaves between two events at one place: it has no direction."""

AT_POLE = 1e-7
"""Part of the domain from a pole inside of which the surface is asked beside it: nearer, the derivative along the pole
has lost half its digits."""

OFF_REGULAR_GRID = 1e-3
"""Part of its step by which a point may be off a regular grid and still counts as standing on it: files of heights
write coordinates with few digits."""

ONE_BREAK_OF_DOMAIN = 1e-7
"""Places, this part of the range of lines that sweep a surface apart, at which curves on it begin, end, turn or cross
are one: a double zero is known to about the root of the rounding."""

BENT_ASIDE_OF_POLE = 1e-3
"""Part of the domain by which derivatives of curvatures are looked at from inside of a pole: nearer to it their
differences are noise."""

AT_APEX = 1e-9
"""Nearer to an apex than this part of a triangle its surface does not bulge."""
