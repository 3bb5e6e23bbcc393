"""Orders that need cuts: faces cut along planes, shapes in slices, a tree of planes."""
