"""The sheet of a verification by the Italian code: its steps, from the site to what each method allows."""
