"""Write a report on a structure, as HTML, PDF or .docx."""

PLACE = 450
