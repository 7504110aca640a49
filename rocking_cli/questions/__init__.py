"""A folder a question: its study, view, picture, verb and command."""
