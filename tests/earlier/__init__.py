"""Plugins as they were written before a structure had `hung`; they stay as they are."""
