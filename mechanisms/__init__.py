"""The built-in mechanisms, found by the entry points `rocking.mechanisms` as those of other packages are."""
