"""Movies as files of polygons: the values, the two files, and what they show."""
