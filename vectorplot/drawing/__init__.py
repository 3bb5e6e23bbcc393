"""The display list and what is done to it: joining, duplicates, layers, pen order, the page."""
