"""The calculation sheet of a verification by the Italian code: steps from the site to the capacity by each method."""
