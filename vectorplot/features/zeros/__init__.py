"""Zero manifolds: where a function of two parameters vanishes."""
