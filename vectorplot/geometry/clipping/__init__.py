"""Lines and polygons cut off at windows, boxes and frustums, many at once.

In space everything is cut in homogeneous coordinates, before any division: a side of the frustum is then a half-space
also behind the eye, where images would be mirrored (errata G2-08, G2-09).
Source: Glaeser, section 2.5.
"""
