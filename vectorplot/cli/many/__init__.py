"""Options and files of commands that make many pictures."""
