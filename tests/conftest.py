"""Settings all tests share."""

from hypothesis import settings

# The same examples on every run: a failure that comes and goes teaches nothing.
settings.register_profile("steady", derandomize=True, deadline=None, max_examples=60, database=None)
settings.load_profile("steady")
