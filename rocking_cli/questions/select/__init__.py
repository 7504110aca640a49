"""`select`: records whose mean spectrum matches a target."""
