"""`respond`: the response to a ground motion or a release."""

PLACE = 70
MORE = {"motions": ["correct", "on_floor", "respond_around", "respond_each"]}
