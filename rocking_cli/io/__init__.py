"""Files and their content: text, YAML, JSON and tables."""
