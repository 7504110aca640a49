"""`spectrum`: peak rotation against size."""

PLACE = 170
