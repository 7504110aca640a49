"""`margin`: how close ground motions are to overturning a structure."""

PLACE = 80
MORE = {"verb": ["shares"]}
