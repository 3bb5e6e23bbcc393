"""The families of surfaces that have names."""
