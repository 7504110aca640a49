"""One folder for each question, with its study, view, picture, verb and command."""
