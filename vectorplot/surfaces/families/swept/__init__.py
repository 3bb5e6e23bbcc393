"""Surfaces that a curve sweeps as it moves: turned, screwed, shifted, carried along another curve."""
