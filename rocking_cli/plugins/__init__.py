"""Plugins of other packages: mechanisms, record readers, pulse shapes and intensity measures."""
