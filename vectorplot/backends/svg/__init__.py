"""SVG, through svgwrite."""
