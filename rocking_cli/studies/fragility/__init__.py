"""How likely a limit state is exceeded at an intensity of shaking, and how often in a year at a site."""
