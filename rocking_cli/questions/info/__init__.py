"""Show the installation: versions, plugins, kernels."""

PLACE = 520
