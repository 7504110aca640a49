"""The sheet of a verification by the Italian code: its steps, from the site to the capacity by each method."""
