"""`score`: stated shares of overturning against tests."""
