"""Plugins of other packages: mechanisms, records, pulses, intensity measures and codes of practice."""
