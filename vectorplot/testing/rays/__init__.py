"""The oracle: what rays from the eye meet."""
