"""Words in which networks state rate, points, unit, peaks and components: one table for five languages."""

from __future__ import annotations

import re
import unicodedata

from rocking_cli.text import regex

# Each row has English, Italian, Spanish, Turkish and romanised Japanese, as expressions for text made `plain`.
_WORDS = {
    "interval": (
        r"(?:sampl(?:e|ing)|time|data)[ -]?(?:intervals?|steps?|period|increment|spacing)|delta ?t|dt"
        r"|(?:equally )?spaced at|(?:points|samples|data) at|intervals (?:at|of)",
        r"(?:passo|intervallo|periodo) (?:di )?(?:campionamento|tempo)|passo temporale",
        r"(?:intervalo|periodo|paso) de (?:muestreo|tiempo)",
        r"ornekleme (?:araligi|periyodu|adimi)|zaman (?:araligi|adimi)",
        r"sa[nm]puringu kankaku|jikan kankaku",
    ),
    "rate": (
        r"sampl(?:e|ing) ?(?:rate|freq(?:uency)?)|samp rate|samples per sec(?:ond)?|sps",
        r"(?:frequenza|velocita) di campionamento|campioni al secondo",
        r"(?:frecuencia|velocidad|tasa|razon) de muestreo|muestras por segundo",
        r"ornekleme (?:hizi|frekansi|sikligi)",
        r"sa[nm]puringu (?:shu(?:u)?hasu+|reeto|rate)",
    ),
    "count": (
        r"npts|ndata|n ?points|n ?samples|(?:number|no\.?|num\.?|total) (?:of )?(?:the )?(?:data|points?|samples?)"
        r"(?: points?| samples?)?",
        r"(?:numero|n\.?|totale) (?:di |dei )?(?:punti|campioni|dati)",
        r"(?:numero|no\.?|num\.?|total) (?:de )?(?:puntos|muestras|datos)",
        r"(?:veri|data|nokta|ornek) sayisi",
        r"(?:deeta|deta|data|sa[nm]puru|ten) ?su+",
    ),
    "counted": (r"(?:data ?)?points|samples|pts", r"punti|campioni", r"puntos|muestras", r"nokta|ornek", r"tensu+"),
    "seconds": (r"s|secs?|seconds?", "secondi", "segundos", "saniye|sn", "byo"),
    "milliseconds": (r"ms|msecs?|milliseconds?", "millisecondi", "milisegundos", "milisaniye", "miribyo"),
    "hertz": ("hz|sps|samples.*|points.*", "campioni.*", "muestras.*", "ornek.*", "herutsu"),
    "time": ("t|time", "tempo", "tiempo", "zaman", "jikan"),
    "unit": (r"units?", r"unita'?(?: di misura)?", r"unidad(?:es)?", r"birim(?:i|ler|leri)?", r"tan'?i"),
    "acceleration": ("acc", r"accelerazion[ei]|acc", "aceleracion(?:es)?", "ivme(?:si)?", "kasokudo"),
    "peak": (
        r"pga|(?:amplitude )?max(?:imum)?|peak(?: ground)?",
        r"picco|(?:valore )?massim[oai]",
        r"maxim[oa]s?|pico|amax",
        r"maksimum|en (?:buyuk|yuksek)|tepe",
        r"saidai(?:chi)?",
    ),
    # A line about one value or the instrument: its unit may differ from that of the record.
    "about a value": (
        r"pg[avd]|peak|max\w*|min|minimum|rms|arias|scaled?|factor|gravity|full[ -]?scale|range|sensitivity|resolution"
        r"|lsb|mean(?! (?:removed|subtracted))|average|st(?:andar)?d\.? dev\w*|clip\w*",
        r"picco|massim\w*|minim\w*|fondo ?scala|fattore|sensibilita|media|risoluzione",
        r"pico|fondo de escala|escala|sensibilidad|promedio|desviacion",
        r"tepe|en (?:buyuk|yuksek|kucuk)|maksimum|ortalama|tam olcek|olcek|duyarlilik",
        r"saidai\w*|saisho\w*|heikin|furusukeeru|kando",
    ),
    # Peaks and numbers of points of something else.
    "something else": (
        r"vel\w*|dis\w*|pgv|pgd|full[ -]?scale|range|factor|sensitivity|freq\w*|period|spectr\w*|fft|filter\w*|taper\w*"
        r"|poles?|vector|resultant|intensity|magnitude|clip\w*|per (?:line|row|block)|lines|resolution",
        r"spostament\w*|fondo ?scala|fattore|filtr\w*|per riga",
        r"desplazamiento\w*|escala|factor|filtr\w*|por (?:linea|renglon)",
        r"hiz\w*|yer ?degistirme|olcek|filtre",
        r"sokudo|hen'?i|shindo",
    ),
    "north": (r"ns?|n-s|sn|s|north(?:-south)?", "nord(?:-sud)?", "norte(?:-sur)?", "k-?g|kuzey(?:-guney)?", "nanboku"),
    "east": (r"ew?|e-w|we|w|east(?:-west)?", r"est(?:-ovest)?", r"este(?:-oeste)?", r"d-?b|dogu(?:-bati)?", "to+u?zai"),
    "up": (r"ud?|u-d|up(?:-down)?|z|v|vert(?:ical)?", "verticale", "vertical", "dusey", "jo+u?ge"),
    "another": (
        r"[lrtxyh]|h[12]|long(?:itudinal)?|tran(?:sverse|sversal|s)?|lat(?:eral)?|rad(?:ial)?|[a-z][nhlg][nez123xyz]|[ns]\d\d?[ew]"
        r"|\d{1,3} ?deg|a[xyz\d]|(?:chan?|channel|comp|component|sensor|ch) ?\.?\w{1,3}",
        "longitudinale|trasversale", "transversal", "boyuna|enine", "",
    ),
}  # fmt: skip
WORDS = {item: "|".join(filter(None, row)) for item, row in _WORDS.items()}
"""Expressions of the words for each item."""

_SIGN = r" *\([+-]\)$|:$"
_COMPONENT = {item: regex(rf"(?:{WORDS[item]})") for item in ("north", "east", "up", "another")}
_OF_ACCELERATION = regex(rf"(?:(?:{WORDS['acceleration']})\w*[ ._-]*)?(.*?)[ ._-]*(?:acc\w*)?")
_BRACKETS = regex(r"\s*(?:\[[^\]]*\]|\((?![+-]\))[^)]*\))")
_JOINED = regex(r"(?<=[a-z]{2})(?=[A-Z])")


def plain(line: str) -> str:
    """Return a line in lower case without accents, with spaces for underscores and between joined words.

    Examples
    --------
    >>> plain("#SampleRate(Hz): 100"), plain("ÖRNEKLEME_HIZI")
    ('#sample rate(hz): 100', 'ornekleme hizi')
    """
    parted = _JOINED.sub(" ", line.replace("_", " "))
    letters = unicodedata.normalize("NFKD", parted.lower().replace("\u0131", "i"))
    return "".join(each for each in letters if not unicodedata.combining(each)).strip()


def without_sign(name: str) -> str:
    """Return the name of a component without its sign or a colon: `E(+)` is `E`."""
    return re.sub(_SIGN, "", name.strip()).strip()


def component(label: str) -> str | None:
    """Return the direction that a label names, or the label itself if it is another component; None if it is none."""
    word = without_sign(_BRACKETS.sub("", plain(label)))
    match = _OF_ACCELERATION.fullmatch(word)
    word = match[1] if match is not None and match[1] else word
    return next(
        (word if item == "another" else item for item, each in _COMPONENT.items() if each.fullmatch(word)), None
    )
