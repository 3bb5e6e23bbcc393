"""Technical drawings: views of a part in line with each other, sections, dimensions."""
