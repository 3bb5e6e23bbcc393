"""Parts of the size of a function, a condition, a derivative, a matrix."""

from __future__ import annotations

FALLS_BESIDE = 1e-3
"""Part of the values beside a change of sign below which a function must come there; at a pole or a jump it does
not."""

FLAT_OF_VALUES = 1e-9
"""Part of the size of a condition that users' functions, and differences of them, may be wrong by: where it is no
larger all over a cell or a triangle, it is zero there."""

ZERO_RESIDUAL = 1e-12
"""Part of the scale of a function down to which it is brought at every point of its zero lines."""

GRID_NOISE = 2.0**-46
"""Part of the scale of a function below which a value at a grid point is rounding, and counts as zero: 64 steps."""

NODE_OF_VALUES = 1e-10
"""Part of the scale of a function of two parameters below which a critical value counts as zero: its lines cross
there."""

NODE_IN_SPACE = 1e-9
"""The same for a condition on an implicit surface, whose derivatives are differences."""

FLAT_NODE = 1e-4
"""A curvature of a function of two parameters below this part of the other one counts as zero: second differences are
known to about the root of the rounding."""

SHALLOW_NODE = 1e-5
"""Ratio of principal slopes below which a critical point in space belongs to a line of them."""

FLAT_CONTACT = 1e-5
"""A relative curvature of two touching surfaces below this part of the other one, or of one by the extent, counts as
zero."""

STEEP_DIRECTION = 1e-6
"""Along a direction whose curvature is less than this part of the other one there is nothing to solve for: there the
difference quotients are noise."""

FIRM_DIRECTION = 1e-7
"""The same for a condition on an implicit surface."""

RANK_OF_BENDING = 1e-8
"""Singular values of a matrix of second derivatives below this part of the largest are none."""

RANK_OF_END = 1e-10
"""Singular values of the equations of a double curve's end below this part of the largest are none."""

RANK_OF_FIT = 1e-12
"""Singular values of the equations of a circle or an ellipse below this part of the largest are none: the points lie on
a line."""

VANISHED_GRADIENT = 1e-6
"""Part of the usual gradient, and of what it makes of the way to go, below which gradient and value are zero."""

NOISE_OF_GRADIENT = 1e-10
"""Part of the usual gradient of an implicit surface that is rounding at the points of its singular lines: their normals
tell nothing."""

VANISHED_VALUE = 1e-9
"""Part of what the usual gradient makes of the way to go below which the value at a singular point is zero: at a double
point it is the square of the gradient."""

VANISHED_ON_LINE = 1e-9
"""Part of the extent by which a point may be off a singular line of an implicit surface, by its gradient and, squared,
by its value, each divided by the second derivatives: more is a line of critical points beside the surface."""

SHALLOW_CROSSING = 1e-6
"""Product of the two larger eigenvalues of the second derivatives of an implicit surface, by their squared size, below
which two sheets do not cross: they touch, or end in a pinch point."""

ZERO_OF_BENDING = 1e-15
"""Part of the usual bending of a contour below which it is zero: where it changes its sign the contour has a cusp."""

LEVEL_CURVATURE = 1e-9
"""Part of the largest curvature along a contour below which one is rounding."""

VANISHED_ON_BORDER = 1e-14
"""Part of the values inside a domain that those on its border are at most where the function vanishes all along it."""

SYMMETRIC_DEVIATION = 1e-9
"""Two ways to cut a cell whose triangles deviate from their normals by sums that differ by less are equally good: what
is symmetric is cut everywhere the same way."""

SINGULAR_PRODUCT = 1e-9
"""Part of the size of the cross product of the partials, or of what the second derivatives allow, below which it
vanishes: at a pole or a singular point."""

SUSPECT_PRODUCT = 1e-6
"""Below this part of the squared size of the surface a cross product is looked at closely: it may be that of a pole."""

SINGULAR_DETERMINANT = 1e-12
"""A determinant below this part of what columns of the same length could have is zero: the matrix has no inverse, the
conic no area."""

INVERSE_SHIFT = 1e-15
"""Part of the largest entry that is added to the diagonal of the equations of an ellipse, so that points that lie
exactly on one leave them solvable."""

RIDGE = 1e-5
"""Part of the size of the equations of handles that is added to them: where handles hardly change the shape, as on a
straight line, their steps stay small."""

DERIVATIVES_AGREE = 1e-6
"""Part of the largest derivative that two ways to compute it may differ by: differences have no more digits."""

VALUES_AGREE = 1e-9
"""A user's function may give values for a whole array that differ by this part from those one by one: more is another
function."""

HOMOTHETIC = 1e-12
"""Two ellipsoids whose forms differ by less than this part are one form in two sizes: what the inverse of a matrix and
two products leave of their digits."""

STANDSTILL_OF_SPEED = 1e-5
"""A curve that is no faster than this part of its speed at the points beside stands still: derivatives by differences
have so many digits."""

EVEN_BENDS = 1e-9
"""Where slopes change on both sides of a point by less than this part of their largest change along the line, Akima's
spline takes the mean of the slopes beside the point: their changes are rounding."""

UMBILIC = 1e-10
"""Part of the curvature by which the principal ones differ at least where a surface has principal directions: second
derivatives and their products have lost six digits by then."""

NODE_OF_RULINGS = 1e-12
"""A discriminant, this part of its largest value away from zero where it is least, touches it: two curves in which a
surface that lines sweep meets another one cross there."""

ALONG_A_RULING = 1e-9
"""A discriminant that is all over below this part of what it is made of is rounding: the lines that sweep a surface run
along the other one, or meet it infinitely far."""

NEIGHBOURS_COUNT = 1e-3
"""What errors of the distance of neighbouring geodesics count for: it says where to go, not where one is."""

LENGTH_ROUGHLY = 1e-3
"""Part of their length that is not known of geodesics which are integrated to say where to begin."""

MET_OF_INTEGRATED = 1e-3
"""Part of the error they are integrated with that geodesics to a place may miss it by."""

BEYOND_NOISE = 4.0
"""Times what curvatures fitted to the normals of a mesh may be wrong by, as the rest of the fit says, by which the
principal ones differ at least where it has principal directions: on meshes of balls and rough planes they differ by
less, but for one face in fifty; on a coarse ring, of 16 by 8 cells, by 4.4 times as much, on finer ones by more."""

SETTLED_FIT = 1e-6
"""Part of the trace of a least-squares fit that is added to its diagonal: what its equations leave open becomes zero,
and what they settle changes by as little."""

SAME_SHADE = 1e-9
"""Shades of one point, found from two triangles at it, differ by rounding only below this part of a palette; those on
two sides of a sharp edge by much more."""

UNSOLVED = 1e12
"""Control points this many times as far out as the points of a spline are none: the equations have no solution."""

RANK_OF_EQUATION = 1e-11
"""A singular value below this part of the largest one is zero."""

OFF_EQUATION = 1e-9
"""So far points of the surface may be off its equation, in parts of its extent."""

WRONG_DERIVATIVE = 1e-3
"""Derivatives that are off by so much of the largest one are wrong, where most of them are."""

LEAST_SLOPE = 1e-3
"""Part of the steepest slope of an equation by which values are divided at least, to be distances."""
