"""Codes of practice: each a folder with a `Code`, found through the entry points `rocking.codes`."""
