"""`spectrum`: peak rotation against size."""
