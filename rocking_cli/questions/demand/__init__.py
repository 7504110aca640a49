"""Show the response spectra of a site by a code."""

PLACE = 230
