"""Readers of drawings and meshes: each makes a `LineDrawing` or a `MeshSurface` of the bytes of a file."""
