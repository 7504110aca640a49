"""`respond`: the response to a ground motion or a release."""
