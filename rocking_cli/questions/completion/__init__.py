"""Print the shell completion script."""

PLACE = 540
