"""Questions asked of many histories or of a mechanism over a range; they know nothing of terminals."""
