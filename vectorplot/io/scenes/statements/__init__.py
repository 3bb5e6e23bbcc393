"""Statements of scene files that make items of their own."""
