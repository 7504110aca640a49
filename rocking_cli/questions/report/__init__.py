"""`report`: the assessment of a structure, as a page."""
