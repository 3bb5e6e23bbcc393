"""Settings all tests share."""

import signal

from hypothesis import settings

# The same examples on every run: a failure that comes and goes teaches nothing.
settings.register_profile("steady", derandomize=True, deadline=None, max_examples=60, database=None)
settings.load_profile("steady")

# Who runs the tests in the background, or under nohup, hands on signals that are ignored; the command would keep them
# so, and tests of what stops it would wait for ever.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
