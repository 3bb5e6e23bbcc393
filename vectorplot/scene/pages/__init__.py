"""Sheets of paper: their sizes, their names, and those that are cut to a picture."""
