"""Select records whose mean spectrum matches a target."""

PLACE = 220
