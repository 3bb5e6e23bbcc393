"""What moves things in the world."""
