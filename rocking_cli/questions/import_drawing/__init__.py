"""`import`: a drawing, or the mesh of a body, as a structure file."""

PLACE = 120
SHORT_HELP = {"import": "Make a structure file of a drawing or a mesh."}
