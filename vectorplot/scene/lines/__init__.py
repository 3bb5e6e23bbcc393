"""Lines on items that a scene asks for besides those of its surfaces: added ones, integral curves, isophotes."""
