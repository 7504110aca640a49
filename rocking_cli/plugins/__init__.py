"""Plugins of other packages: mechanisms, record readers, pulse shapes, intensity measures and codes of practice."""
