"""Draw a structure at rest and displaced, with dimensions."""

PLACE = 130
