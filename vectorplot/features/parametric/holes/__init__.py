"""The holes of a surface: where its domain has no points, and the rims of those areas."""
