"""The commands, each in its file: their options, and the call that answers them."""
