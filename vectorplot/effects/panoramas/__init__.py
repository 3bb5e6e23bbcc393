"""What is seen all round from a place, unrolled."""
