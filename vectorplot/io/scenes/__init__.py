"""The scene language: read and written."""
