"""`record`: what is in a record."""
