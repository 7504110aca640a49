"""`pulse`: the response to a pulse."""
