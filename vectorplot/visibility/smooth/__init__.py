"""Hidden lines on smooth surfaces: the events along each curve, and one decision for each piece between them."""
