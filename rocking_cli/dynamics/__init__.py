"""Time histories: models of structures, kernels that simulate them, and the outcomes."""
