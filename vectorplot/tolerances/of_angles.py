"""Angles, and their sines and cosines."""

from __future__ import annotations

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
