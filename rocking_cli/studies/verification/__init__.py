"""Verification of rocking mechanisms by a code: the frame, and in `codes` a module for each."""
