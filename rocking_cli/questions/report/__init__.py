"""`report`: the assessment of a structure, as a page."""

PLACE = 210
