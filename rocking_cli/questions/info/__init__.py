"""Show the installation: versions, plugins, kernels, defaults."""

PLACE = 250
