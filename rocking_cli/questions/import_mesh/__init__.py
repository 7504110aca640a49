"""`import_mesh`: the mesh of a body, such as the scan of a statue, as a structure."""

PLACE = 125
