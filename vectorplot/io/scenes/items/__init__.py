"""The items of scene files: their words, read one after the other into drafts, and what these are made into."""
