"""What the verbs have in common: the walk over stages, what a picture is of, and what stands beside it."""
