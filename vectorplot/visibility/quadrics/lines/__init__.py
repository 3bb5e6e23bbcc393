"""The lines on bodies, and those in which they meet each other and polyhedra."""
