"""Plugins of other packages: mechanisms, records, pulses, intensity measures, codes of practice and engines."""
