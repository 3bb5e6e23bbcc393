"""Curves of one field that keep their distance from each other and leave no gaps."""
