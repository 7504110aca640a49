"""Write a page that answers as motion and structure change."""

PLACE = 455
