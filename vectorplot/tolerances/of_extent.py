"""Lengths as parts of the extent of what is looked at: a scene, a shape, a curve.

Views are normalised: there the scene is about 1 large, and the numbers are lengths.
"""

from __future__ import annotations

ZERO_OF_EXTENT = 1e-9
"""A distance below this part of the extent of what is looked at counts as zero: a million times the rounding of
coordinates, and a thousandth of the finest detail that anything can show."""

CUT_EDGE_OF_EXTENT = 1e-7
"""A border with both ends no farther from the plane of a cut is an edge of the cut: rims of smooth surfaces are found
to about a hundredth of this, and nothing that can be told from them by eye is nearer."""

CUT_FACE_CHORD_OF_EXTENT = 1e-5
"""The faces of cuts through smooth surfaces end at chords no farther than this part of the surface's extent from the
true section: two thousandths of a millimetre on usual pages. Their edges are drawn from the section."""

SECTION_ENDS_OF_EXTENT = 1e-7
"""Ends of sections of neighbouring parts of a surface that are no farther apart are one point."""

SAME_PLANE_OF_EXTENT = 1e-6
"""Hatched faces with one normal whose heights agree when rounded to so much lie in one plane, and share their lines."""

ROUNDING_OF_POINTS = 1e-14
"""Part of the largest coordinate by which computed points of a surface differ where they should be one: some fifty
steps of doubles, as a formula with sines and roots may lose."""

RESIDUAL_OF_EXTENT = 1e-13
"""Part of the extent that a point may lie off the surface it was led to: what Newton's method reaches everywhere in
doubles, rounding of the surface's formula included."""

SETTLED_OF_EXTENT = 1e-13
"""A ray or a curve that misses its sheet by less than this needs no further step: the next one would be rounding."""

MET_OF_EXTENT = 1e-10
"""A ray or a curve meets a sheet where the two come closer than this: a thousand times what the search reaches where
they cross, and far less than they are apart where they do not."""

NEARLY_MET = 1e-7
"""A search for a meeting goes on from what is nearer than this after its first steps; Newton squares it in the next."""

SETTLED_ON_SHEET = 1e-12
"""A point no farther from its foot on a sheet needs no further step: a thousandth of what counts as zero."""

CROSSING_RESIDUAL = 1e-11
"""How far the images of a crossing of two curves may be apart."""

MODEL_RESIDUAL = 1e-6
"""The same while the curves are replaced by cubic arcs, which are good to about this."""

MEETING_RESIDUAL = 1e-12
"""Part of the extent that the two points of a meeting of two surfaces may be apart."""

END_RESIDUAL = 1e-11
"""Part of the extent that the two places of a surface may be apart where a double curve ends: their difference is
divided by a small distance there, which costs two digits."""

END_SETTLED = 1e-15
"""The same when no further step can help."""

TOUCHING_OF_EXTENT = 1e-7
"""A sheet less than this in front of a point is one that the point lies on, or touches: places of events are known to
the square root of the rounding where curves touch."""

AROUND_OF_EXTENT = 1e-6
"""A point lies on the border of what hides it where that does not hide all places so far beside it: ten times as far as
what counts as touching."""

ON_SURFACE = 1e-7
"""A ray test takes a point no further from a surface than this part of the extent for one on it."""

GAP_IN_FRONT = 1e-6
"""An edge less than this in front of a curve is one that the curve touches."""

FOLDS_GAP = 1e-3
"""The same for two parts of one contour: on both sides of a cusp they are as close as rounding long before that."""

ONE_MEETING = 1e-6
"""Meetings of a sight line closer together than this, in space and as places, are one."""

SAME_HIT = 1e-6
"""A refined hit of a test ray farther from the unrefined one than this part of the extent is on another sheet."""

OWN_HIT = 1e-3
"""A hit nearer to a point on the surface than this part of the extent is the point itself."""

NET_ERROR = 5e-6
"""The net of test rays is made so fine that it is within this part of the scene's extent, as far as its most cells
allow: five times what tells two hits apart."""

LOCAL_MEETING = 1e-3
"""Nearer than this, the second meeting of a sight line with the sheet of its point is told by curvature: there the two
roots of Newton's method are too close to be told apart."""

CONTACT_MEETING = 1e-4
"""From a contour, meetings nearer than this are the contour itself."""

SAFE_IN_IMAGE = 1e-3
"""A sight line that passes all edges at this distance in the image is trusted: about a tenth of a millimetre on a sheet
of paper."""

COVERED_MARGIN = 1e-7
"""A cell counts as covered only where it is so far inside, as free only where it is so far outside: more than the
rounding of singles, which boxes are kept in."""

SMALLEST_CELL = 1e-9
"""No cell of the grid over the image is smaller: what is finer counts as a point."""

HALO_MARGIN = 1e-6
"""Boxes of outlines grow by this part of their largest coordinate: they are compared in single precision."""

ONE_LINE_OF_EXTENT = 1e-6
"""Lines no further apart than this part of half the scene's extent are in one place: that is more than what rounding to
single precision does to them."""

FLAT_OF_EXTENT = 1e-6
"""Corners no farther off a plane than this part of the extent lie in it: coordinates in files of single precision are
off by a tenth of it."""

GAP_OF_EXTENT = 1e-6
"""A surface given by functions with a larger gap than this part of its extent between its two ends does not close:
values of users' formulas have ten digits and more."""

ONE_POINT_OF_EXTENT = 1e-6
"""Points where two surfaces touch are found to the square root of the rounding: closer ones are one."""

ON_MESH_BORDER = 1e-8
"""Part of the extent of a mesh within which an end of a curve is on a border edge."""

DOT_OF_EXTENT = 1e-7
"""Part of the extent below which a closed curve on an implicit surface is a point."""

APART_OF_EXTENT = 1e-4
"""Isolated points of an implicit surface's curves closer than this part of the extent are one: they are found from two
sides, and where the condition is flat each is known badly."""

LAST_STEP_OF_EXTENT = 1e-6
"""Points that have arrived on an implicit surface take one step more if it is no longer than this part of the extent:
it gains digits, and cannot lead elsewhere."""

SETTLED_ON_LINE = 1e-11
"""Part of the extent that the last step onto a singular line of an implicit surface may be: Newton's method squares it
in the next one."""

SAME_ON_LINE = 1e-8
"""Points of singular lines no further apart than this part of the extent are one: each is known to a thousandth of it,
where lines do not end."""

CRITICAL_SETTLED = 1e-8
"""Part of the extent that the last step to a critical point in space may be: second derivatives are differences there,
so that Newton's method gains two or three digits a step."""

SECOND_DIFFERENCE_IN_SPACE = 1e-5
"""Part of the extent over which second derivatives in space are differences of first ones: about the third root of the
rounding, where rounding and curvature spoil a difference equally."""

CHORD_OF_EXTENT = 1e-3
"""Chords stay within this part of the extent of the true curve where neither a tolerance nor a picture is given: a
fifth of a millimetre where the shape fills a sheet of paper."""

FINEST_CHORD_OF_EXTENT = 1e-7
"""Chords are no nearer to curves than this part of half the scene's extent, however small a part a picture shows: finer
ones would be many more than a picture can tell apart."""

THINNEST_BOX = 2e-4
"""A box thinner than this part of its largest side is made that thick: a plane between two boxes then has a
direction."""

FLAT_PICTURE = 1e-12
"""A picture narrower than this part of its other side has no width: it is fitted by the other side alone."""

NO_DIGITS_OF_EXTENT = 1e-3
"""A scene whose coordinates are known no better than this part of its extent, so far from the origin it is, is
refused."""

NEAR_OF_DISTANCE = 1e-4
"""The near plane, as a part of the smaller of the eye's distance from its target and the scene's extent: near enough
that nothing visible is cut off, far enough that what passes the eye keeps finite images."""

LAMP_OF_EXTENT = 1e-6
"""What is nearer to a lamp than this part of the scene's extent, along the middle of its view, casts no shadow: the
lamp may lie in its own shade."""

MAP_BIAS = 1e-5
"""Part of the depth of a shadow map that is added to the bias: what single precision may lose of depths."""

IN_SURFACE_OF_DISTANCE = 1e-30
"""A point so near to a refracting surface, as a part of the distances to the eye, is as good as in it: squares of the
ratio still are numbers."""

SIGHT_DIFFERENCE = 1e-6
"""Step in the image, in units of the view, over which derivatives of refracted rays are taken as differences."""

SIGHT_SETTLED = 1e-14
"""Refracted rays that a step moves by less, in units of the image, have been found."""

SPREAD_OF_EXTENT = 1e-10
"""Ends of strokes are moved by so little before pens are ordered, each by another amount: no two distances are equal
any more, and no order changes that is not a tie."""

DRAWN_TOGETHER_OF_EXTENT = 1e-7
"""Ends that take the lines of a hatching to and fro come together by so little: more than what breaks ties."""

DISTANCE_ACCURACY = 1e-9
"""The default accuracy of the distance between curves, as a part of the extent of both."""

CLEARANCE_OF_EXTENT = 1e-6
"""Samples of a drawing that pass an edge nearer than this part of the extent are not asked: there a ray decides
nothing."""

REACH_OF_CLEARANCE = 1e-3
"""Clearances of test rays are measured up to this part of the extent: what is farther is clear."""

FOOT_OF_EXTENT = 1e-9
"""A point that is further from the surface than this part of the extent may have been led to the wrong foot."""

GAUSS_OF_EXTENT = 1e-6
"""Nearer to a surface than this part of the extent Gauss's and Newton's method are the same in all but name."""

FOOT_REACHED = 1e-17
"""A distance below this part of the extent is none: less than the rounding of any coordinate."""

INTEGRATED_OF_EXTENT = 1e-9
"""What the estimated errors of all steps of an integral curve, as long as the extent of its surface, add up to, where
nothing else is said."""

INTEGRATED_AS_DRAWN = 1e-5
"""The same for curves that are only to be drawn: two thousandths of a millimetre where the surface fills a sheet of
paper."""

STALLED_OF_EXTENT = 1e-7
"""An integral curve ends where no step of this part of the extent succeeds: at critical points, where its direction
jumps or is no longer real."""

INTEGRATED_TO_MEET = 1e-7
"""The same for geodesics between two places: estimates are of steps of one order less, so that eight digits are
right."""

GEODESIC_MET = 1e-11
"""A geodesic that is led to a place meets it where it is as near as this: a thousand roundings of points."""

ONE_GEODESIC_OF_EXTENT = 1e-6
"""Geodesics between the same places that differ by less than this in length and angle are one; places nearer than this
are one, and conjugate where neighbours are no farther aside for each unit of angle."""

CLOSED_OF_EXTENT = 1e-7
"""A curve that comes back to its start, nearer than this, is closed: a hundred times the error it is integrated with,
and nothing that a drawing can show."""

ROAD_ARRIVES = 1e-8
"""A road of constant slope that comes so near to its end, as a part of the terrain, arrives there: errors of thousands
of edges add up."""

THIRD_DIFFERENCE_IN_SPACE = 1e-4
"""Part of the extent over which third derivatives in space are differences of second ones, which may be differences
themselves, known to about 1e-12."""

COLOURED_OF_EXTENT = 3e-4
"""Part of the extent of a scene within which smooth surfaces become triangles that get colours by numbers: a twentieth
of a millimetre on a page."""

UNITED_OF_EXTENT = 1e-12
"""Part of the largest coordinate that the meshes of a grid have on which regions are united where floating numbers do
not lead to a union: a few thousand of their last digits."""
