"""`record`: what is in a record."""

PLACE = 50
MORE = {"verb": ["response_spectrum"]}
