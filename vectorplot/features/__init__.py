"""The lines on a shape: edges, contours, intersections, patterns."""
