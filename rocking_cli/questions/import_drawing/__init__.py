"""`import`: a drawing, or the mesh of a body, as a structure file."""

PLACE = 245
