"""`demand`: the response spectra of a site by a code of practice."""

PLACE = 85
