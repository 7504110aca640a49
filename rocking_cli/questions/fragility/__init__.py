"""`fragility` and `results`: many histories, kept in a store, and the curves fitted to them."""

PLACE = 190
MORE = {"own_data": ["fit_fragility"], "results": ["results"]}
