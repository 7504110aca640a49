"""The calculation sheet of a verification: every formula with its numbers, in the language asked for."""
