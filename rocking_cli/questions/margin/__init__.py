"""`margin`: how close ground motions are to overturning a structure."""
