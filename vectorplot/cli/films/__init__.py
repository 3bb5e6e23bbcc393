"""The commands that make frames, and what they share."""
