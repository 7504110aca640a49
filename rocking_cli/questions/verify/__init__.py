"""`verify`: a mechanism verified by a code of practice."""

PLACE = 90
