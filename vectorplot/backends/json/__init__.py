"""Drawings as JSON."""
