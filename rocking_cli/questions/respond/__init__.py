"""`respond`: the response to a ground motion or a release."""

PLACE = 70
MORE = {"motion_verbs": ["correct", "on_floor", "respond_around", "respond_each"]}
