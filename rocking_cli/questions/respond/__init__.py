"""Compute the response to a ground motion or a release."""

PLACE = 310
MORE = {"each_verb": ["respond_each"], "motion_verbs": ["correct", "on_floor", "respond_around"]}
