"""Lines that lie on each other: drawn once, and of one kind."""
