"""Where the gradient of an implicit surface vanishes, and where curves on it cross or shrink to points."""
