"""Files of heights: grids and scattered points."""
