"""What is in the same place: items that stand in one another, and points that polyhedra share."""
