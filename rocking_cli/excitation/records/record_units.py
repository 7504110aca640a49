"""Words and units of headers, in five languages: where a header states a unit, which is never guessed.

Other recorded values are displacements, velocities, volts and counts.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Literal, NamedTuple, get_args

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.text import did_you_mean, exact, regex
from rocking_cli.units import CHOICES, KINDS, QUANTITY, UNITS, header_unit

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


_S = r"s(?:ec)?"
_OVER_S2 = rf" ?/ ?{_S} ?(?:\^|\*\*)? ?2| ?/ ?{_S} ?/ ?{_S}"
_PER_S2 = rf"(?:{_OVER_S2}|[ .·*]?{_S} ?(?:\^|\*\*)? ?-2|[ p]?s2)"
# A unit ends where its word ends, and is not the first part of something else: g/10, cm/s of cm/s2, g = 9.81.
_END = r"(?! ?[/^*=]|\w)"
_OF_G = r"milli-? ?g|mg|(?:%|percent|pct) ?g"
# Units that are clear by themselves, which a bare "g" is not.
_SPELLED = rf"(?:(?:mm|cm|m){_PER_S2}|(?:ft|in)(?:{_OVER_S2})|gals?|{_OF_G}){_END}"
_UNIT = rf"(?:{_SPELLED}|g{_END})"
_SPEED = rf"(?:mm|cm|m|km|in|ft)(?: ?/ ?(?:{_S}|h)| s-1){_END}"
_LENGTH = rf"(?:mm|cm|m|km|inch(?:es)?|ft|feet){_END}"
_FOREIGN = rf"(?:km{_PER_S2}|counts?){_END}"

_ACCELERATION = rf"\b(?:acc(?:l|n|el|eln|els|eleration|elerations)?|{WORDS['acceleration']})(?![a-z])\.?"
_MOTION = regex(r"\b(?:vel|velocity|velocities|disp|displ|displacements?)\b")
_GAP = r"[ ,:;=-]*(?:in |of )?"
_UNITS_OF = rf"\b(?:{WORDS['unit']})[ :=]*(?:(?:of|are|is|in|di|de) |{_ACCELERATION})*[ :=]*"

_BRACKETED = regex(rf"[\[(]\s*({_UNIT})\s*[\])](?! ?(?:[/^*]|x ?\d))")
_NAMED = [
    regex(pattern)
    for pattern in (
        rf"{_ACCELERATION}{_GAP}({_UNIT})",  # for example: accel_g, acceleration, m/s2
        rf"{_ACCELERATION}.*\bin ({_UNIT})",  # for example: acceleration time series in g
        rf"{_UNITS_OF}({_UNIT})",  # for example: units of g, units: cm/s2
        rf"\bin ({_SPELLED})",
        rf"\ba ?g?[ ,:;=-]*({_SPELLED})",  # for example: a_m/s2; but a_g is the ground acceleration, in any unit
        rf"^(?:s|secs?|seconds?)[ ,;\t]+({_UNIT})$",  # for example a row of units: s,g
        rf"(?:^|, *)({_SPELLED})(?:,|$)",
    )
]
# A line about one value, such as the peak, whose unit may differ from that of the record.
_ABOUT_A_VALUE = regex(rf"\b(?:{WORDS['about a value']})\b")
_NOT_USABLE = regex(rf"(?:{_UNITS_OF}|{_ACCELERATION}{_GAP})[\[(]?({_SPEED}|{_FOREIGN})|{_UNITS_OF}({_LENGTH})")
# Text in place of a unit: after the word, or in brackets in the label of a column other than the time.
_STATED_UNIT = regex(
    r"\bunits? *(?:[:=]|of |are |is |in )[ :=]*[\[(]?(?!(?:acc\w*|the|time)\b)([^\s,;\])]{1,20})", re.IGNORECASE
)
_SAID_LABEL = regex(r"[\[(] *(?!(?:m?s|secs?|seconds?|-*) *[\])])([^\])\s]{1,20}) *[\])](?! ?[/^*])", re.IGNORECASE)
_NOT_USABLE_LABEL = regex(rf"[\[(]\s*({_SPEED}|{_LENGTH}|{_FOREIGN})\s*[\])]")


def is_unit(word: str) -> bool:
    """Return whether a word is the unit of a time, a length, a speed or an acceleration, and nothing else."""
    return re.fullmatch(rf"m?s|secs?|seconds?|{_UNIT}|{_SPEED}|{_LENGTH}|{_FOREIGN}", _normal(word)) is not None


def is_acceleration(line: str) -> bool:
    """Return whether a header line names an acceleration."""
    return re.search(_ACCELERATION, _normal(line)) is not None


def header_units(line: str) -> set[str]:
    """Return the canonical units that a header line states for the accelerations; units in brackets come first."""
    line = _normal(line)
    if _ABOUT_A_VALUE.search(line):
        return set()
    spellings = _BRACKETED.findall(line) or [match for pattern in _NAMED for match in pattern.findall(line)]
    return {unit for spelling in spellings if (unit := header_unit(spelling))}


def resolve_unit(
    file: str, header: Sequence[tuple[int, str]], units: str | None, quantity: Quantity
) -> tuple[str, float]:
    """Return name and size of the unit of the values in a file, from its header or as given by the user.

    Parameters
    ----------
    file : str
        The file, for the messages.
    header : sequence of (int, str)
        Line number and text of every header line; the column labels, if there are any, come last.
    units : str, optional
        The unit the user gave.
    quantity : str
        Quantity of the values.

    Returns
    -------
    (str, float)
        The unit, of accelerations one of `UNITS`, and its size in SI units.

    Raises
    ------
    InputError
        If neither header nor user gives a unit, the two differ, the header has several, or is about another quantity.
    """
    size, known = None if units is None else size_of(units, quantity), ", ".join(units_of(quantity))
    if units is not None and size is None:
        message = f"'{units}' is not a unit of {quantity}"
        raise InputError(Problem(message, field=named("units"), hint=f"choose one of: {known}"))
    if quantity == "acceleration":
        units = units and header_unit(units)
        stated = {unit: number for number, line in reversed(header) for unit in sorted(header_units(line))}
        _refuse_other_quantities(file, header)
    else:
        _refuse_another(file, header, quantity)
        spelled = (
            (unit, number) for number, line in reversed(header) for unit in map("".join, _IN_HEADER.findall(line))
        )
        stated = dict(islice((each for each in spelled if size_of(each[0], quantity) is not None), 1))
    sizes = {unit: size_of(unit, quantity) or math.nan for unit in stated}
    alike = [unit for unit in stated if size is not None and math.isclose(size, sizes[unit])]
    if size is not None and stated and not alike:
        unit, number = next(iter(stated.items()))
        message = f"the header says the unit is {unit}, but {named('units')} says {units}"
        raise InputError(Problem(message, file, number, hint=f"leave {named('units')} out, or correct the header"))
    if units is not None and size is not None:
        return alike[0] if alike and quantity == "acceleration" else units, size
    if not stated:
        raise InputError(_not_said(file, header, quantity))
    if not all(math.isclose(one, other) for one in sizes.values() for other in sizes.values()):
        message = f"the header names more than one unit: {', '.join(stated)}"
        hint = f"say which one holds for the accelerations with {named('units')}: {known}"
        raise InputError(Problem(message, file, max(stated.values()), hint=hint))
    return next(iter(sizes.items()))


def _not_said(file: str, header: Sequence[tuple[int, str]], quantity: Quantity) -> Problem:
    """Return the problem of a header without a unit, or with one that is not in `UNITS`."""
    hint = f"say which it is with {named('units')}: {', '.join(units_of(quantity))}"
    if quantity != "acceleration":
        hint += f"; or with {named('gain')}, such as {GAIN_EXAMPLE}"
        return Problem(f"the file does not say what unit its {plural(quantity)} are in", file, hint=hint)
    for index, (number, line) in enumerate(header):
        if _ABOUT_A_VALUE.search(_normal(line)):
            continue
        match = _STATED_UNIT.search(line) or (_SAID_LABEL.search(line) if index == len(header) - 1 else None)
        if match and header_unit(match[1]) is None:
            message = f"the header says '{match[1]}', which is not a known unit of acceleration"
            return Problem(message, file=file, line=number, hint=hint)
    return Problem("the file does not say what unit its accelerations are in", file=file, hint=hint)


def _refuse_other_quantities(file: str, header: Sequence[tuple[int, str]]) -> None:
    """Raise `InputError` if a header states a velocity or displacement, or a unit that cannot be read."""
    about_acceleration = any(header_units(line) or is_acceleration(line) for _, line in header)
    for index, (number, line) in enumerate(header):
        label = index == len(header) - 1
        what = other_quantity(line, label=label)
        # Only labels surely describe the columns; elsewhere "peak velocity" may be mere information.
        if what and (label or not about_acceleration):
            hint = (
                f"give the ground acceleration, in one of: {CHOICES}; or say what it is by {named('quantity')}, "
                f"or by the {named('gain')}"
            )
            raise InputError(Problem(what, file=file, line=number, excerpt=line.strip()[:100], hint=hint))


def _refuse_another(file: str, header: Sequence[tuple[int, str]], quantity: Quantity) -> None:
    """Raise `InputError` if all units of the labels, or of a line on units, are of other quantities."""
    for number, line in header:
        units = BRACKETED.findall(line) if number == header[-1][0] else []
        units += _OF_UNITS.findall(line)
        stated = {kind: unit for unit in units if (kind := quantity_of(unit)) is not None}
        if stated and quantity not in stated:
            other, unit = next(iter(stated.items()))
            message = f"the header says that the values are in {unit}, a unit of {plural(other)}"
            hint = f"is it {named('quantity')} {other}?"
            raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=hint))


def other_quantity(line: str, *, label: bool = True) -> str | None:
    """Return why a header line contradicts accelerations in a usable unit, a sentence; None if it does not.

    Parameters
    ----------
    line : str
        The line, or the label of one column.
    label : bool, optional
        Whether the line certainly labels columns, so that a unit in brackets is that of the values.

    Returns
    -------
    str or None
        What is wrong with the line, as a sentence.
    """
    if header_units(line):
        return None
    line = _normal(line)
    match = _NOT_USABLE.search(line) or (_NOT_USABLE_LABEL.search(line) if label else None)
    if match:
        unit = match[match.lastindex or 0]
        if re.fullmatch(_FOREIGN, unit):
            return f"accelerations in '{unit}' cannot be read"
        return f"the header gives the unit '{unit}': a velocity or displacement, not an acceleration"
    if _MOTION.search(line) and not is_acceleration(line):
        return "the header speaks of velocity or displacement, not acceleration"
    return None


def _normal(line: str) -> str:
    """Return a line made plain, with one spelling of powers and minus signs."""
    line = plain(line)
    for old, new in (("\N{MINUS SIGN}", "-"), ('"', " "), ("'s", "")):
        line = line.replace(old, new)
    return line.strip()


Quantity = Literal["acceleration", "velocity", "displacement"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
_KINDS: dict[Quantity, str] = {"acceleration": "acceleration", "velocity": "velocity", "displacement": "length"}
GAIN_EXAMPLE = "0.05 m/V"
MIN_GAIN, MAX_GAIN = 1e-30, 1e30  # products overflow beyond these bounds
TIME_UNITS = frozenset(
    ["s", "sec", "second", "seconds", "ms", "min", "minute", "minutes", "h", "hr", "hour", "hours", "d", "day", "days"]
)

_IN_HEADER = regex(rf"[\[(]\s*([^\])]+?)\s*[\])]|\bin\s+(?!units?\b)([^\s,;]+)|{_UNITS_OF}([^\s,;]+)", re.IGNORECASE)
_OF_UNITS = regex(rf"{_UNITS_OF}([^\s,;]+)", re.IGNORECASE)
BRACKETED = regex(r"[\[(]\s*([^\])]+?)\s*[\])]")
_PER = regex(r"(.+?)\s*(?:/|\bper\b)\s*([^\W\d_%]{1,20}|%)")


class Wanted(NamedTuple):
    """Request to a reader with `TAKES_WANTED = True`, beyond accelerations at even times.

    Parameters
    ----------
    quantity : str
        Quantity of the values in the file; the reader returns them in place of accelerations, in SI units.
    raw : bool
        Whether the values are the output of an instrument: they are then returned unchanged, whatever their unit.
    uneven : bool
        Whether times may be uneven: the values are then interpolated to an even grid, and a `Doubt` states how uneven
        the times are.
    run_on : bool
        Whether the values are one series that runs on over the rows, from left to right.
    despite_header : bool
        Whether the numbers of points and the peaks that the header states may be those of another, longer record.
    """

    quantity: Quantity = "acceleration"
    raw: bool = False
    uneven: bool = False
    run_on: bool = False
    despite_header: bool = False

    @property
    def values(self) -> str:
        """The values in words, in the plural."""
        return "values" if self.raw else plural(self.quantity)

    @property
    def of_accelerations(self) -> bool:
        """Whether accelerations are requested, and not the output of an instrument."""
        return self.quantity == "acceleration" and not self.raw

    def unit(self, file: str, header: Sequence[tuple[int, str]], units: str | None) -> tuple[str, float]:
        """Return name and size of the unit of the values; arguments and errors are those of `resolve_unit`."""
        if self.raw:
            for number, line in header:
                if stated := header_units(line):
                    message = f"the header says that the values are in {', '.join(sorted(stated))} already"
                    hint = f"leave {named('gain')} out"
                    raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=hint))
            return "raw", 1.0
        return resolve_unit(file, header, units, self.quantity)


ACCELERATIONS = Wanted()


class Asked(NamedTuple):
    """Arguments of a reader of this package: those of `formats.Reader.read`, and what is wanted."""

    dt: float | None = None
    units: str | None = None
    channel: str | None = None
    wanted: Wanted = ACCELERATIONS

    def unit(self, file: str, header: Sequence[tuple[int, str]]) -> tuple[str, float]:
        """Return name and size of the unit of the values, as `Wanted.unit`."""
        return self.wanted.unit(file, header, self.units)


def plural(quantity: Quantity) -> str:
    """Return the plural of a quantity, in words."""
    return "velocities" if quantity == "velocity" else f"{quantity}s"


def units_of(quantity: Quantity) -> tuple[str, ...]:
    """Return the units in which a quantity may be given."""
    return tuple(UNITS if quantity == "acceleration" else KINDS[_KINDS[quantity]])


def size_of(unit: str, quantity: Quantity) -> float | None:
    """Return the size of a unit of a quantity, in SI units; None if it is not a unit of this quantity."""
    name = header_unit(unit, _KINDS[quantity])
    return None if name is None else float(KINDS[_KINDS[quantity]][name])


def quantity_of(unit: str) -> Quantity | None:
    """Return the quantity of a unit; None if it is not that of an acceleration, velocity or displacement."""
    return next((each for each in QUANTITIES if size_of(unit, each) is not None), None)


@dataclass(frozen=True)
class Gain:
    """Value of one unit of an instrument's output.

    Parameters
    ----------
    size : float
        Value in m/s2, m/s or m, not zero; a negative one reverses the motion.
    quantity : str
        Quantity of the value.
    text : str
        The gain as written: `0.05 m/V`.
    """

    size: float
    quantity: Quantity
    text: str

    def __str__(self) -> str:
        return self.text

    @classmethod
    def parse(cls, text: str) -> Gain:
        """Read a gain such as `0.05 m/V`, `1.5e-5 m/count` or `2 g/V`; the unit after the slash is optional.

        Raises
        ------
        InputError
            If the text has no number, or no unit of acceleration, velocity or length.
        """
        match = QUANTITY.fullmatch(text.strip())
        if match is None or not MIN_GAIN <= abs(float(match[1])) <= MAX_GAIN:
            raise _refused(f"{text!r} is not a number with a unit")
        number, unit = match[1], match[2]
        if unit is None:
            raise _refused(f"{text!r} is a gain without a unit")
        per = None if quantity_of(unit) else _PER.fullmatch(unit)
        if per is not None and per[2].lower() in TIME_UNITS:
            raise _refused(f"{unit!r} is not a known unit, and {per[2]!r} is not an output of an instrument")
        of = unit if per is None else per[1]
        quantity = quantity_of(of)
        if quantity is None:
            known = [name for each in QUANTITIES for name in units_of(each)]
            raise _refused(f"{of!r} is not a unit of acceleration, velocity or length", did_you_mean(of, known))
        size = size_of(of, quantity)
        assert size is not None
        return cls(float(number) * size, quantity, f"{exact(float(number))} {unit}")


def _refused(message: str, guess: str | None = None) -> InputError:
    hint = f"{guess}; " if guess else ""
    hint += f"say what one unit stands for, such as {GAIN_EXAMPLE}"
    return InputError(Problem(message, field=named("gain"), hint=hint))
