"""Run a fragility study and fit its curves."""

PLACE = 510
MORE = {"own_data": ["fit_fragility"], "results": ["results"]}
SHORT_HELP = {"results": "Summarise and export the store of a study."}
