"""Graphs of functions, the regions they stand above, and heights on grids."""
