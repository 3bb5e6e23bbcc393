"""Smooth surfaces as the second engine sees them."""
