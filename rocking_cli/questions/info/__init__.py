"""`info`: what is installed."""
