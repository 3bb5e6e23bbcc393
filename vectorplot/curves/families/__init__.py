"""The families of curves that have names."""
