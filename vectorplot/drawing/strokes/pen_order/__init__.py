"""The order in which a pen draws strokes."""
