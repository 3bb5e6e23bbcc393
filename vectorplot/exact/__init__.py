"""Decisions that are never guessed: signs of predicates, sets of intervals."""
