"""Fragility: the probability that a limit state is exceeded at an intensity, and its annual rate at a site."""
