"""Formulas in files: parsed and differentiated, never evaluated as code."""
