"""`record`: the contents and the strength of a record."""

PLACE = 50
MORE = {"verb": ["response_spectrum"]}
