"""Parametrised and implicit surfaces, and their families."""
