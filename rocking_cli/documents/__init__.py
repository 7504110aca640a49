"""A report on one structure: a document of one file to hand over."""
