"""Views of results: rows, plain data and sentences for output, one result in each file."""
