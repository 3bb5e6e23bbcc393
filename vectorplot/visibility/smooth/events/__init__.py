"""Where the visibility of a curve may change."""
