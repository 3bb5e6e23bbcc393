"""The stages of the verb paint: what is seen, in its colours or blank, with lines on it."""
