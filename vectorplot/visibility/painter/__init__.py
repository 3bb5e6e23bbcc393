"""The painter's algorithm: what lies behind is drawn first."""
