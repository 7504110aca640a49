"""Plugins as they were written before what hangs on a structure was told from its mechanism; they stay as they are."""
