"""Scenes as charts: colours by numbers with their bar, and boxes with ticks."""
