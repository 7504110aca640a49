"""The English texts of a calculation sheet by any code."""

from __future__ import annotations

MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip
MECHANISMS: dict[str, str] = {}
CAUTIONS: dict[str, str] = {}
PICTURES: dict[str, str] = {}
TEXTS = {
    # head
    "title": "Calculation sheet: {name}",
    "project": "Project",
    "place": "Place",
    "author": "Author",
    "date": "Date",
    "site_name": "Site",
    "program": "Program",
    "logo": "Logo",
    "sections": "Sections",
    "skip": "Skip to the summary",
    "swipe": "On a narrow screen, swipe tables and the picture sideways to see all of them.",
    "quantity": "quantity",
    "symbol": "symbol",
    "value": "value",
    "unit": "unit",
    "unit years": "years",
    # how to read it
    "reading": "How to read it",
    "per_kilogram": "The file gives no masses: weights are per kilogram of the whole structure, in N/kg.",
    # drawing
    "drawing": "Drawing",
    "drawing_label": "{name} at rest with its dimensions, and displaced to its critical rotation",
    # inputs
    "inputs": "Files and versions",
    "inputs_are": "Run this command with these files and versions to reproduce the sheet.",
    "files": "Files",
    "file": "file",
    "structure_file": "structure",
    "site_file": "site",
    "record_file": "record",
    "pulse": "pulse, computed from its formula",
    "versions": "Versions",
    "package": "package",
    "version": "version",
    "structure_text": "Structure file",
    "site_text": "Site file",
    "cut": "(the file continues: {more} more lines are not printed)",
    "source": "Mechanism: {source}.",
}
