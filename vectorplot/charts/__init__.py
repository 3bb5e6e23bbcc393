"""Charts: numbers over numbers on logarithmic axes, as drawings with letters of single strokes."""
