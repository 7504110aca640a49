"""The calculation sheet of a verification: every formula with its numbers, in a chosen language."""
