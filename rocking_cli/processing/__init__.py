"""Processing of ground motions before they excite a structure: reading, correction, rotation, motion of a floor."""
