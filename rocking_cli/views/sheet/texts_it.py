"""The Italian texts of a calculation sheet by any code."""

from __future__ import annotations

MONTHS = (
    "gennaio", "febbraio", "marzo", "aprile", "maggio", "giugno", "luglio", "agosto", "settembre", "ottobre",
    "novembre", "dicembre",
)  # fmt: skip
MECHANISMS = {
    "arch": "arco circolare in muratura a quattro cerniere",
    "asymmetric_frame": "trave su due pilastri di diversa altezza",
    "block": "blocco rettangolare isolato",
    "cone": "guglia conica",
    "curve": "struttura assegnata mediante la curva di capacità",
    "point_mass": "massa puntiforme su asta priva di massa con base rigida",
    "rigid_body": "corpo rigido di forma qualsiasi",
    "spanning_wall": "parete vincolata tra due solai, con carico in sommità",
    "symmetric_frame": "pilastri uguali sotto una trave semplicemente appoggiata",
    "wall": "parete soggetta a flessione verticale fuori piano, trattenuta in sommità",
}
CAUTIONS = {
    "curve": (
        "l'inerzia è costante e la restituzione ricavata dalla cinematica è quella di un solo corpo rigido su due "
        "appoggi: per più corpi se ne assegni una misurata."
    ),
    "wall": (
        "non è a favore di sicurezza in assenza di carico in sommità: la cerniera è fissata a metà altezza, dove "
        "λ = 2 tan α. Sotto il solo peso proprio la cerniera più sfavorevole sta più in alto, e lì sono minori sia λ "
        "sia lo spostamento disponibile."
    ),
}
PICTURES = {
    "at rest": "a riposo",
    "positive (clockwise)": "verso positivo (orario)",
    "negative (anticlockwise)": "verso negativo (antiorario)",
}
TEXTS = {
    # head
    "title": "Relazione di calcolo: {name}",
    "project": "Progetto",
    "place": "Luogo",
    "author": "Redatto da",
    "date": "Data",
    "site_name": "Sito",
    "program": "Programma",
    "logo": "Logo",
    "sections": "Sezioni",
    "skip": "Vai alla sintesi",
    "swipe": "Su uno schermo stretto le tabelle e il disegno scorrono lateralmente.",
    "quantity": "grandezza",
    "symbol": "simbolo",
    "value": "valore",
    "unit": "unità",
    "unit years": "anni",
    # how to read it
    "reading": "Come leggere la relazione",
    "per_kilogram": "Il file non assegna le masse: i pesi sono per chilogrammo dell'intera struttura, in N/kg.",
    # drawing
    "drawing": "Disegno",
    "drawing_label": "{name} a riposo, con le dimensioni, e spostato fino alla rotazione critica",
    # inputs
    "inputs": "File e versioni",
    "inputs_are": "Con questi file e queste versioni il comando seguente scrive di nuovo la relazione.",
    "files": "File",
    "file": "file",
    "structure_file": "struttura",
    "site_file": "sito",
    "record_file": "accelerogramma",
    "pulse": "impulso, dalla sua formula",
    "versions": "Versioni",
    "package": "pacchetto",
    "version": "versione",
    "structure_text": "File della struttura",
    "site_text": "File del sito",
    "cut": "(il file prosegue: {more} righe non sono stampate)",
    "source": "Fonte del meccanismo: {source}.",
}
