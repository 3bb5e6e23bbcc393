"""Orders for the painter that need no comparisons, and how outlines lie on each other."""
