"""The table of tolerances: what counts as zero, as equal, as found or as settled, each with a name and a reason.

All are relative, each section to something else: what they are multiplied with stands where they are used. A small
number anywhere else in the package fails a test. docs/tolerances.md shows the whole table.

Source: Glaeser, sections 1.1 and 3.1 (central constants); errata G1-03, G1-06.
"""

from __future__ import annotations

# Angles, and their sines and cosines.

PARALLEL_SINE = 1e-12
"""Directions that are given, and enclose an angle with a smaller sine, count as parallel: a thousand roundings."""

SAME_DIRECTION_SINE = 1e-9
"""Directions that are computed, of tangents and borders, or that a user adjusts, as the up vector is against the line
of sight, are one below this sine: products of theirs keep half their digits."""

EDGE_ON_SINE = 1e-9
"""Sine of the angle between a sight line and a plane below which the plane is seen edge-on."""

VERTICAL_SINE = 1e-15
"""A line of sight whose horizontal part is no longer is vertical: a few roundings of a unit vector, as a camera that
looks down has azimuth 0 only then."""

TRUE_NORMAL_SINE = 1e-7
"""Normals that a CAD system tells are wrong by less: a face that makes a smaller angle with the view is seen edge-on.
Its surfaces are no farther apart at common edges than a ten millionth of their size."""

NO_CAD_NORMAL = 1e-6
"""Where both parameter lines of a face of a part span an area no larger than this part of what the longest ones of the
face could, its surface has no normal there: at the tip of a cone, the pole of a ball."""

CAD_EDGE_OFF_FACE = 1e-4
"""An edge of a part lies on its faces if it is no farther off than this part of the body, a fiftieth of a mm on a page
of 200 mm: files of other programs are off by 1e-5 to 6e-5. A body with an edge farther off is drawn from triangles."""

RING_OPEN = 1e-5
"""Edges of a part end where the next ones begin if they end no farther from there than this part of their face, in u
and v: files hold them so, and a slit between them would let lines through. Edges that come back so near are closed."""

PIECES_OFF_EDGE = 1e-8
"""Cubic pieces of an edge of a part are off it by no more than this part of its size: a tenth of what counts as
touching where a sight line leaves a face."""

SEWN_OF_EXTENT = 1e-5
"""Faces of a file without solids are joined along edges that are no farther apart than this part of all of it: a
hundredth of a millimetre of a metre, as systems for surfaces have it."""

NO_AZIMUTH_SINE = 1e-6
"""Near the zenith, below this sine, an azimuth has so few digits that the up vector says how a picture stands."""

RIGHT_ANGLE_COSINE = 1e-12
"""An angle with a smaller cosine is a right one."""

PARABOLA_SINE_SQUARED = 1e-12
"""Tangents whose angle has a smaller squared sine do not meet anywhere near: no parabola has them."""

LEAST_SINE_SQUARED = 1e-14
"""Parameter lines are taken to enclose an angle of this squared sine at least: where they run along each other, at a
singular point, steps along them stay numbers."""

TOUCHING_SHEETS_SINE = 1e-6
"""Sine below which two sheets touch rather than cross: a course of such points is noise."""

ALONG_EDGE_SINE = 1e-6
"""Sine below which a curve does not cross an edge but runs along it in the image."""

SEEN_ALONG_SINE = 1e-6
"""A chord that makes a smaller angle with the sight line is a point in the image: all of a scene's extent is no longer
there than places on cubic arcs are off."""

ALONG_SHEET_SINE = 1e-7
"""A curve that makes a smaller angle with a sheet touches it."""

ROUGHLY_ALONG_SHEET_SINE = 1e-4
"""The same while the curve is replaced by cubic arcs: the slopes of these are off by about so much."""

GRAZING_ANGLE = 1e-4
"""Sight lines that meet a sheet at a smaller angle, in radians, only touch it: there they are no farther behind it than
points are known."""

ON_CONTOUR_SINE = 1e-6
"""Test rays that make a smaller angle with the tangent plane touch the surface: the point is one of its contour."""

FOLDED_ANGLE_SQUARED = 1e-6
"""Halves of a quadrilateral that turn from each other by an angle with a square below this are one plane face."""

FLAT_COSINE = 1.0 - 1e-8
"""Cosine of the angle between a normal and that of its face where the face is flat: less than a hundredth of a
degree."""

NO_NORMAL = 1e-9
"""Unit normals, weighted with angles, that add up to no more cancel out: the vertex has no normal."""

WHOLE_TURN = 1e-9
"""An arc that turns by a whole turn but for so many radians is the whole ellipse."""

STRAIGHT_TURN = 1e-6
"""A polygon that turns by fewer radians at a corner goes straight on there: no circle has corners so close."""

LOOP_TURN = 1e-6
"""Angles seen from the middle of a loop add up to a whole turn but for so many radians; anything else is off by a
turn."""

HALF_TURN_ROUNDING = 1e-9
"""Part of a half turn by which an angle given in degrees may differ from it and still is one."""

ABOUT_AXIS = 1e-9
"""Angles and distances about an axis that differ by less, as a part of a turn and of the scene, may be the same."""

SOLID_ANGLE_ROUNDING = 1e-3
"""Solid angles of a closed mesh around a point inside add up to that of a sphere but for so much: anything else is off
by half of it or more."""

UNIT_LENGTH = 1e-6
"""What the length of a direction that fields give in faces of meshes may differ from one by, and the sine of its angle
with the face: those of single precision are good enough."""

FLAT_SLOPE = 1e-12
"""Sine of the slope of a surface below which it is level, and has no direction of steepest slope: a thousand roundings
of a unit normal."""

SAME_PLANE_SINE = 1e-6
"""Normals of hatched faces that agree when rounded to so much are those of one plane: lines run on from one to the
other, and are as far off as the thickness of a pen's line where they are not."""

NARROW_CONIC = 1e-7
"""A section of a mantle, of a plane along its rulings, that turns by less about the axis is straight: it is off its
chord by less than a rounding of the radius."""

SAME_NORMAL_COSINE = 1.0 - 1e-6
"""Normals at a pole with a smaller cosine between them are different."""

FACES_APART = 1e-6
"""Faces about an edge that are closer, in radians, lie on each other."""


# Lengths as parts of the extent of what is looked at: a scene, a shape, a curve.
#
# Views are normalised: there the scene is about 1 large, and the numbers are lengths.

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

FERMAT_NEAR = 1e-6
"""Where steps of a search for the point of a mirror that shows another one are shorter, in units of the extent or as a
part of the distance of the two, lengths of ways differ by rounding and are asked no more; two steps of Newton's lead
from there to the end."""

SHADOW_OF_LINE = 1e-7
"""A line is seen in a curved mirror up to this part of itself before what the mirror hides: nearer, light grazes the
mirror, and the square of this is how far off the image is."""

FERMAT_RESIDUAL = 1e-10
"""A point of a mirror shows another one where the directions to eye and point differ from mirrored ones by less, as
unit vectors: a thousand times what the search reaches."""

NEARLY_MET = 1e-7
"""A search for a meeting goes on from what is nearer than this after its first steps; Newton squares it in the next."""

SETTLED_ON_SHEET = 1e-12
"""A point no farther from its foot on a sheet needs no further step: a thousandth of what counts as zero."""

LIMIT_OF_LEVELS = 2.0**-27
"""Patches around an irregular vertex of a subdivision surface are told apart until its edges are no longer than this
part of those of the cage: what is nearer is at the vertex, to the square of this by rounding."""

BESIDE_BORDER = 2.0**-14
"""So far inside of a patch with a corner on a smooth border, and no edge across that, the tangents at the corner are
taken: along both of its edges they are one."""

SAG_OF_LIMIT = 2.5e-4
"""Nine in ten patches of a subdivision surface are divided until chords are no further from it than this part of its
size: a few hundredths of a mm on a page. Points of contours are exact whatever it is."""

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

NEAR_SURFACE_OF_EXTENT = 1e-4
"""A point no farther than this from a surface, inside of a body too, belongs to the place of it that is nearest: what
users write of points on surfaces has four digits, and on a sheet of paper it is as far as strokes may be off."""

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

BESIDE_OUTLINE = 2e-8
"""So far beside the outline of a polyhedron light is looked for: ten times what counts as zero in a view."""

BEHIND_OUTLINE = 2e-4
"""So far before and behind an outline light is looked for: faces that the light meets at angles down to the quotient of
the other distance and this one, a ten-thousandth, are told from those behind them."""

BESIDE_SMOOTH_OUTLINE = 1e-6
"""So far beside the outline of a smooth surface a ray passes it for certain, and meets the same behind it."""

BEHIND_SMOOTH_OUTLINE = 1e-4
"""Nearer than this to the place where a ray grazes a smooth surface it throws no shadow: what is met there is the
surface itself."""

AWAY_FROM_LIT_ENDS = 1e-6
"""Part of a line that is left out at either end where it is looked whether it is lit: what ends there may touch it."""

LEAST_RAY_STEP = 2.0**-30
"""Places that are nearer to each other than this part of a line are on one ray: a billionth of a line, as what counts
as zero."""

FINEST_RAY_STEP = 2.0**-40
"""Between places that are nearer to each other than this part of a line nothing more is looked for: at a fold, where
shadows run as the square root of it, they are within a millionth."""

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

OFF_IN_SINGLE = 1e-4
"""Part of the size of a shape by which single precision may move its points unsaid where it is written as STL: shapes
up to some hundred sizes off the origin are as good as others."""

UNITED_OF_EXTENT = 1e-12
"""Part of the largest coordinate that the meshes of a grid have on which regions are united where floating numbers do
not lead to a union: a few thousand of their last digits."""

DEVELOPABLE_ANGLE = 1e-6
"""A surface is developable where its tangent plane turns by no more along its straight lines, as a sine, and these are
no less straight: unrolled, lengths of it change by the square of that."""

UNROLLED_OF_LENGTH = 1e-12
"""Part of a development by which points may move when it is integrated in steps half as long: then it is found."""

SAME_SCORE = 1e-9
"""Two nets of a body are as good as each other where what is to be cut of them, as a part of all edges, differs by
less: the one found first is taken."""

UNITED_GRID_OF_ZERO = 2.0**-6
"""Part of the distance that counts as zero that the meshes of the grid have on which faces of bodies are united: far
finer than what is one point, so that what two planes make of a point is one however flat they meet."""

SAME_POINT_OF_ZERO = 4.0
"""Corners of a union of bodies so many times nearer than what counts as zero are one: each is off by up to that, in
the plane it was found in."""


# Lengths as parts of other lengths: of a chord, a cell, a stroke, a tolerance, a step.

FIT_OF_TOLERANCE = 1e-3
"""Errors of fitted segments below this part of the tolerance are equal: which of them is joined first does not
matter."""

ARC_OF_TOLERANCE = 1e-3
"""An arc of an ellipse is one only if all points agree within this part of the tolerance: what was an arc agrees to
rounding, and what merely resembles one does not."""

ONE_CIRCLE_OF_RADIUS = 1e-3
"""Circles through three neighbouring corners each, whose middles are no farther apart than this part of their radius,
are perhaps one: points in a row that pass are looked at as a whole."""

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

BEFORE_CUT = 1e-6
"""Within this part of a chord before the plane that ends a curve the last place on the cut surface is looked for."""

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

FINEST_DRAWN_MM, FINEST_PAINTED_MM = 1e-4, 1e-3
"""Tolerances at which pictures that have a time to keep are as fine as they get: a tenth of the last digit of the
files, and a shade of which no more is seen."""

ERROR_SAID = 1e-6
"""Errors below this, in mm, pixels or shades, are those of rounding: a picture that keeps a promise does not name
them."""

LEAST_TOLERANCE_MM = 1e-6
"""A thousandth of the last digit of the files: who asks for a finer one has missed a power of ten."""


# How well errors are measured: what truth is made of, and down to where approximations are tried.

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

OUTERMOST_OF_EXTENT = 1e-3
"""Vertices within this part of the extent from the end of a part are where dimensions of the whole begin: triangles of
round parts fall short of it by less, and an extension line that begins so much beside the part looks right."""

PLAIN_NUMBER = 1e-3
"""Smaller numbers stand at an axis as powers of ten."""


# Numbers that come from how doubles and singles are stored: their steps, and the ends of their range.

LEAST_VALUE = 2.0**-1022
"""The smallest normal double: a value of it stands on one side of zero, where a line meets zero at its own end."""

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
a first test; what passes is looked at in doubles."""

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


# Parts of a surface's domain, of a box, or of a curve's range of parameters.

ROUNDING_OF_DOMAIN = 1e-12
"""A place this part of the domain away from a border, or from another place, is there: some thousand roundings of
parameters, and no visible step."""

ON_BORDER_OF_DOMAIN = 1e-9
"""An end of a curve this part of the domain away from a border or a seam is on it: ends are computed, not given."""

OUTSIDE_DOMAIN = 1e-9
"""Part of the domain, or of the box of an implicit surface, that a place may be outside of it and still belongs to
it."""

ON_TRIM = 1e-9
"""A place this part of the domain away from a curve that trims a surface lies on it, and belongs to the surface: files
hold parameters to twelve digits, and seams would be slits."""

BESIDE_TRIM = 1e-6
"""Part of the domain beside a curve that trims a surface, and part of a piece of it from its ends, at which is looked
to which side the surface lies: a thousand times what counts as on the curve, and nothing that is seen."""

STRAIGHT_TRIM = 1e-3
"""Pieces of a trimming curve that meet at a smaller sine go on as one without a corner: they come from curves that are
smooth, to within what they may be off these."""

TRIMS_APART = 1e-7
"""Part of what trimming curves measure to which they are flattened to see whether they cross: of nearer ones it may be
said that they do."""

PLACES_IN_CELLS = 2.0**-40
"""Places in cells that trims cut are rounded to so small parts of the domain, so that neighbours have them in common:
a thousandth of what counts as on the trim."""

TRIM_CURVE_OFF = 1e-8
"""Part of its size by which the cubic pieces that a trimming curve is made of may be off it: nanometres on a page, and
the pieces are what the curve is from then on."""

REPEATED_OF_DOMAIN = 1e-9
"""Points of a curve this part of the domain apart repeat each other: one of them goes."""

DOT_OF_DOMAIN = 1e-8
"""A curve no longer than this part of the domain is one point: it has no more than ten points that differ."""

JUMP_OF_DOMAIN = 1e-8
"""Part of the domain over which positions jump where they are farther apart than the tolerance: on the way there parts
of the domain were cut by three at least fifteen times."""

LEVEL_STEP_OF_DOMAIN = 1e-5
"""A step of this part of a domain tells which way a direction on a surface leads in its development: a hundred times
what lengths in the plane are off, and so short that nothing bends in it."""

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

PINCH_SETTLED = 1e-9
"""A pinch point has been found when the last step to it is shorter than this part of the domain: second derivatives of
a user's function have no more digits."""

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


# Millimetres on the page.

COINCIDENT_MM = 1e-4
"""Strokes that are no further apart than this lie on each other, ends on the same point: a tenth of what a file's
numbers keep."""

CERTIFIED_MM = 1e-3
"""Certificates leave strips of this width open beside outlines: ten times what strokes may be off where they join."""

LONE_STROKE_MM = 0.05
"""Strokes that are shorter, and from whose ends none goes on, are specks: a third of the width of the finest pens for
drawing, whose dots show no direction."""

COLLINEAR_MM = 1e-4
"""A point that is no further from the straight line between its neighbours is left out. So a stroke moves by less than
a millionth of a picture on a sheet of paper: what is drawn stays as visible as it was found to be."""

TOUCHING_AT_MM = 1e-4
"""Curves of a sheet of paper's size that touch in four points at once are so close over the length below which a shared
part only touches; where points are known less well, over more of it, by the fourth root."""

EXACT_MM = 1e-4
"""A Bézier curve that is no farther off a curve, at most, is the curve: a tenth of what files keep."""

GRID_MM = 1e-4
"""Corners of regions lie on a grid of so many millimetres; the scene's own have digits to spare."""

CLEARANCE_MM = 1e-3
"""What is cut away is wider by this than what lies above it: of two sides that nearly coincide nothing is left between
them, which would be drawn as wide as a seam."""

SIDE_BY_SIDE_MM = 0.01
"""Transparent polygons that overlap in strips narrower than this lie side by side: a strip of it is a tenth of a pixel
of a screen wide at most, on most of them less."""

ARC_DECIMAL_MM = 1e-5
"""Unit of the numbers of arcs: their radii and centres are kept better than their ends."""

HATCH_GAP_MM = 0.005
"""Strokes of a hatching on one line that are no further apart are one: between the parts of a region that was cut to
pieces there are gaps of some GRID_MM, and no pen shows them."""

STEP_BORDER_MM = 0.005
"""Borders between steps of shade are known to a part of a triangle's size: points that are no further from the chord of
their neighbours say nothing, and no pen shows them."""


# Parts of the size of a function, a condition, a derivative, a matrix.

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

VANISHED_ON_BORDER = 1e-14
"""Part of the values inside a domain that those on its border are at most where the function vanishes all along it."""

SYMMETRIC_DEVIATION = 1e-9
"""Two ways to cut a cell whose triangles deviate from their normals by sums that differ by less are equally good: what
is symmetric is cut everywhere the same way."""

SINGULAR_PRODUCT = 1e-9
"""Part of the size of the cross product of the partials, or of what the second derivatives allow, below which it
vanishes: at a pole or a singular point."""

RANK_OF_PINCH = 1e-3
"""Sine, about, of the angle between the derivatives of the cross product of the partials below which it does not turn
round: along cuspidal edges and at poles it keeps its direction."""

SUSPECT_PRODUCT = 1e-6
"""Below this part of the squared size of the surface a cross product is looked at closely: it may be that of a pole."""

SINGULAR_DETERMINANT = 1e-12
"""A determinant below this part of what columns of the same length could have is zero: the matrix has no inverse, the
conic no area."""

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

SAME_CORNER_NORMAL = 1e-4
"""Normals at one corner of facets, interpolated on each of these, differ by rounding only below this; those on two
sides of a sharp edge by much more."""

SHADOW_CORNER_MM = 1e-4
"""Corners of shadows on neighbouring facets are one if they are in one cell of this size on the page: a hundredth of
what is written. They differ by a few tolerances of the view, thousands of times less."""

FACET_CORNER_MM = 1e-3
"""Corners of bands on facets are rounded to so much on the page: where layers of facets meet, gaps are no wider."""

SAME_AREA = 1e-9
"""Shadows cover a facet if their areas add up to its own but for such a part: rounding leaves a thousandth of it, and
such as overlap, or leave some of the facet free, differ by more."""

UNSOLVED = 1e12
"""Control points this many times as far out as the points of a spline are none: the equations have no solution."""

RANK_OF_EQUATION = 1e-11
"""A singular value below this part of the largest one is zero."""

LOST_IN_DIFFERENCES = 1e-3
"""The root of a difference smaller than this part of what is subtracted has lost digits that another expression for it
has."""

OFF_EQUATION = 1e-9
"""So far points of the surface may be off its equation, in parts of its extent."""

WRONG_DERIVATIVE = 1e-3
"""Derivatives that are off by so much of the largest one are wrong, where most of them are."""

LEAST_SLOPE = 1e-3
"""Part of the steepest slope of an equation by which values are divided at least, to be distances."""

CERTIFIED_POLE = 1e-8
"""Where an end of a domain is one point, so small a part of the domain is left out of certificates: its image has no
size."""

CERTIFIED_FORMULA = 1e-11
"""Formulas in certificates give the points of the surface they stand for, but for so much, relative to its size."""

MEANT_AT_POLE = 1e-6
"""So near to a pole, as a part of the domain, curves of certificates are meant to be in it."""

CERTIFIED_DAMPING = 1e-3
"""How strongly steps of Levenberg and Marquardt's method are damped where places on surfaces are looked for, as a part
of the trace."""

USUAL_PART_TOLERANCE = 5e-5
"""Chords of edges of CAD parts are no farther off than this part of the diagonal of all that is read: 0.02 mm on a page
A4."""

SAME_REACH_OF_EXTENT = 1e-7
"""Where the box that OpenCASCADE tells of a part is no farther off its triangles than this part of its diagonal, theirs
counts: on some surfaces it adds 1e-7 mm."""

LEAST_PART_TOLERANCE = 2e-6
"""Finer ones take minutes to read."""

OFF_PAGE_MM = 1e-6
"""Letters that leave their page by less, which may be rounding, are on it."""
