"""View of a verification by any code, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from itertools import groupby
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Self, TypeVar

from rocking_cli.core import Direction, Mechanism
from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.plugins.errors import guard
from rocking_cli.studies.remark import Remark, in_plain
from rocking_cli.verification.code import codes
from rocking_cli.verification.results import Verification, Verified, Working
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, table_of
from rocking_cli.views.conclusion import conclusion_data, next_in_words, of_verification, uncounted_ties
from rocking_cli.views.sheet.language import ENGLISH, Language, texts_of, translated
from rocking_cli.views.view import Table, View, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure


F = TypeVar("F", bound=Verification)
V = TypeVar("V", bound=Verified)
SHOWN = ("of_direction", "in_short", "compared", "data", "data_of_all", "table", "draw")
"""Methods that a code may override; their failures are errors of the plugin."""
BOTH = "Both directions"


class MethodRow(NamedTuple):
    """A method in a direction, and whether it governs there."""

    direction: Direction
    key: str
    method: Any
    governs: bool


METHODS: Sequence[Column[MethodRow]] = (
    Column(None, of("direction.label"), name="direction", text=True),
    Column(None, of("key"), name="method", text=True),
    only_shown("", of("method.title"), text=True),
    Column("capacity", of("method.capacity"), head="capacity"),
    Column("demand", of("method.demand"), head="demand"),
    Column("unit", of("method.unit"), head="unit", text=True),
    Column("ratio", of("method.ratio"), head="ratio"),
    Column("passes", of("method.passed"), name=None),
    Column("clause", of("method.clause"), head="clause", name=None, text=True),
    Column(None, of("governs"), head="", form={True: "governs", False: ""}.__getitem__, name="governs", text=True),
)
STEPS: Sequence[Column[Working]] = (
    only_shown("", of("symbol"), text=True),
    only_shown("formula", of("formula"), text=True),
    only_shown("numbers", of("numbers"), text=True),
    only_shown("result", of("value"), number),
    only_shown("unit", of("unit"), text=True),
    only_shown("clause", lambda line: cited(line), text=True),
    only_shown("meaning", of("meaning"), text=True),
)


def rows_of(found: Verification) -> list[MethodRow]:
    """Return a row for each direction and method."""
    return [
        MethodRow(direction, key, method, key == each.governs)
        for direction, each in found.directions.items()
        for key, method in each.methods.items()
    ]


class Showing(Generic[F, V]):
    """Presentation of the results of a code; a code that shows other results overrides methods.

    Attributes
    ----------
    of_site : sequence of str
        Symbols of the lines of the site's calculation to show, in order; empty for all.
    say : Language
        How the keys of remarks are said.
    say_in_short : Language, optional
        How they are said in the short view, which leaves out those that it says as empty texts; by default as `say`.
    package : str
        The package with texts in other languages: `texts/LANGUAGE.toml`, and `texts/LANGUAGE_in_short.toml` if shorter
        ones are said in short.
    notation : str
        How clauses are cited, such as ": [formula] or §section".
    """

    of_site: Sequence[str] = ()
    say: Language = ENGLISH
    say_in_short: Language | None = None
    package: str = "rocking_cli.views.sheet"
    notation: str = ""

    def in_language(self, key: str) -> Self:
        """Return how they are shown in a language; a text that it lacks stays in English."""
        if key == ENGLISH.key:
            return self
        spoken, texts, english = copy(self), texts_of(self.package, key), texts_of(self.package, ENGLISH.key)
        meanings = {f"shown {in_plain(text)}": in_plain(texts[name]) for name, text in english.items() if name in texts}
        spoken.say = Language(key, {**meanings, **texts}, is_plain=True)
        spoken.say_in_short = replace(spoken.say, own={**spoken.say.own, **texts_of(self.package, f"{key}_in_short")})
        return spoken

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a subclass, so that errors in them are reported as errors of the plugin."""
        super().__init_subclass__(**named)
        guard(cls, SHOWN, lambda own, method: f"{own.__qualname__} failed in {method}")

    def of_direction(self, found: F, each: V, where: str) -> Iterable[Table | str]:
        """Return the tables and sentences of a direction, which `where` names."""
        return [*self.in_short(found, each, where), *map(self.say, each.remarks)]

    def in_short(self, found: F, each: V, where: str) -> Iterable[Table | str]:
        """Return the tables and sentences of a direction without which its verdict cannot be judged; no remarks."""
        rows = [row for row in rows_of(found) if row.direction is each.direction]
        return [table_of(f"{where}: capacity by method", METHODS, rows), verdict(self.say, each, where)]

    def compared(self, found: F, strengthened: F) -> Iterable[Table | str]:
        """Return the methods of the existing structure and of the strengthened one, in the directions that decide."""
        rows = [
            (method.title, *(of.deciding.methods[key].ratio for of in (found, strengthened)))
            for key, method in found.deciding.methods.items()
        ]
        names = ("", "existing", "strengthened")
        columns = [only_shown(name, itemgetter(k), number if k else str) for k, name in enumerate(names)]
        yield table_of("Capacity over demand by method", columns, rows)

    def data(self, found: F, each: V) -> dict[str, Any]:
        """Return a direction as plain data."""
        return {
            "methods": {row.key: data_of(METHODS, row) for row in rows_of(found) if row.direction is each.direction},
            "governs": each.governs,
            "ratio": each.ratio,
            "passes": each.passed,
            "remarks": list(map(self.say, each.remarks)),
        }

    def data_of_all(self, found: F) -> dict[str, Any]:
        """Return as plain data what does not belong to one direction."""
        return {
            "site": {
                f"{each.symbol} {each.state}".strip(): each.value for each in map(Working.in_plain, found.workings)
            },
            "remarks": list(map(self.say, found.remarks)),
        }

    def table(self, found: F) -> Mapping[str, Sequence[Any]]:
        """Return a table as columns, with a row for each direction and method."""
        return frame_of(METHODS, rows_of(found))

    def draw(self, found: F) -> Figure:
        """Return a plot of the verification. Raises `InputError` if the code has none."""
        raise InputError(Problem(f"{found.code} has no picture of a verification", hint="leave out the plot"))


def showing(found: Verification) -> Showing[Any, Any]:
    """Return how the results of the code of a verification are shown."""
    return showing_by(found.code)


def showing_by(code: str) -> Showing[Any, Any]:
    """Return how the results of a code are shown."""
    shown_by = codes()[code].showing()
    if shown_by is None:
        return Showing[Any, Any]()
    if not isinstance(shown_by, Showing):
        raise PluginError(f"the code {code} failed in showing: it must return a Showing or None")
    return shown_by


def view(
    found: Verification, site: str | None = None, *, language: str = "en", every_step: bool = False,
    in_short: bool = False,
) -> View:  # fmt: skip
    """Show the methods side by side for each direction, which governs, and remarks.

    Parameters
    ----------
    found : Verification
        The verification.
    site : str, optional
        Name of the site.
    language : str
        Language of tables and sentences, such as "it"; the data are the same.
    every_step : bool
        Whether to show also every line of the calculation: symbol, formula, numbers, result and clause.
    in_short : bool
        Whether to show only what is needed to judge the verdict, with remarks in short.
    """
    shown_by = showing(found).in_language(language)
    parts, say = list[Table | str](), shown_by.say
    if found.strengthened is None:
        parts += _sentences(found, site, say)
    else:
        parts += _sentences(found, site, say, "Existing structure:")
        parts += _sentences(found.strengthened, site, say, "Strengthened structure:")
        parts += shown_by.compared(found, found.strengthened)
    if found.strengthened is None or not in_short:
        parts += (_in_short if in_short else _in_full)(found, shown(found, say), shown_by)
    if found.strengthened is not None and not in_short:
        parts += _in_full(found.strengthened, shown(found.strengthened, say), shown_by, say(", strengthened"))
    every = list[Working]()
    for lines, where in _workings(found, say):
        every += lines
        parts += steps(lines, where) if every_step else ()
    parts.append(standing(every, None if in_short else shown_by.notation, say))
    mechanisms = [each.mechanism for each in (found, found.strengthened) if each is not None]
    parts += dict.fromkeys(say("Caution: {text}", text=text) for each in mechanisms for text in cautions_of(each, say))
    return translated(say, View(lambda: data(found), [part for part in parts if part]))


def named(mechanism: Mechanism, say: Language) -> str:
    """Return name and type of a structure in a language, for a heading."""
    return f"{mechanism.name}: {say.mechanism(mechanism.mechanism, mechanism.title)}"


def _sentences(found: Verification, site: str | None, say: Language, of: str = "") -> list[str]:
    """Return the conclusion in sentences: first the ties that do not count; `of` begins each."""
    mechanism, by = found.mechanism, {"code": say(found.name), "edition": say(found.edition)}
    end, of, where = found.conclusion, of and f"{say(of)} ", say(", at {site}", site=site) if site else ""
    first, concluded = uncounted_ties(end, say), of_verification(found, say)
    head = say("{structure}, by the {code} ({edition}){where}.", structure=named(mechanism, say), where=where, **by)
    answer = " ".join(filter(None, [head, *concluded[len(first) :], next_in_words(end, say)]))
    return [f"{of}{each}" for each in (*first, answer)]


def _workings(found: Verification, say: Language, of: str = "") -> Iterator[tuple[Sequence[Working], str]]:
    """Yield the lines of a calculation, and the direction to which they belong."""
    yield found.workings, ""
    for where, each in shown(found, say).items():
        yield each.workings, f"{where}{of}"
    if found.strengthened is not None:
        yield from _workings(found.strengthened, say, say(", strengthened"))


def _in_full(
    found: Verification, sides: Mapping[str, Any], shown_by: Showing[Any, Any], of: str = ""
) -> Iterator[Table | str]:
    """Yield the ground, all of each direction, which of them governs, and the remarks."""
    if found.workings:
        yield _site(found, shown_by.of_site)
    for where, each in sides.items():
        yield from shown_by.of_direction(found, each, f"{where}{of}")
    if len(sides) > 1:
        yield _which_direction(shown_by.say, found)
    yield from map(shown_by.say, found.remarks)


def _in_short(found: Verification, sides: Mapping[str, Any], shown_by: Showing[Any, Any]) -> Iterator[Table | str]:
    """Yield what decides, and the remarks in short: tables that directions share, what each has alone, and the rest."""
    say = shown_by.say_in_short or shown_by.say
    both = say(BOTH) if len(sides) > 1 else next(iter(sides))

    def parts_of(each: Any, where: str) -> Iterator[Table | str]:
        yield from shown_by.in_short(found, each, where)
        lead = "" if where == both else f"{where}: "
        yield from (f"{lead}{text}" for text in map(say, each.remarks) if text)

    alike = [list(parts_of(each, both)) for each in sides.values()]
    shared = [part for part in alike[0] if all(part in parts for parts in alike)]
    yield from (part for part in shared if isinstance(part, Table))
    for (where, each), parts in zip(sides.items(), alike, strict=True):
        named = zip(parts_of(each, where), parts, strict=True)
        yield from (with_direction for with_direction, part in named if part not in shared)
    yield _which_direction(say, found) if len(sides) > 1 else ""
    yield from (part for part in shared if isinstance(part, str))
    yield from map(say, found.remarks)


def shown(found: Verification, say: Language = ENGLISH) -> dict[str, Any]:
    """Return the directions that differ, by their names."""
    if len(found.distinct) < len(found.directions):
        return {say(BOTH): found.distinct[0]}
    return {say(f"{one.direction.label.capitalize()} direction"): one for one in found.distinct}


def _which_direction(say: Language, found: Verification) -> str:
    """State which direction governs, with the ratios of both; empty if none does."""
    least = found.governs
    one, other = found.compared(least), found.compared(least.opposite)
    if found.alike or None in (one, other) or found.conclusion.direction not in ("", least.label):
        return ""
    return say("direction_governs", way=say.recognised("shown", least.label), one=one, other=other)


def verdict(say: Language, each: Verified, where: str) -> str:
    """Return a sentence on whether a direction passes, and its margin."""
    counts = each.counts
    if each.passed is None or each.ratio is None:
        return say("verdict_missing", where=where)
    values = {"where": where, "method": f"{counts.title[0].upper()}{counts.title[1:]}", "ratio": each.ratio}
    values |= {
        "capacity": say.number(counts.capacity, 4),
        "demand": f"{say.number(counts.demand, 4)} {counts.unit}".rstrip(),
    }
    return say("verdict_passes" if each.passed else "verdict_fails", **values)


def _site(found: Verification, symbols: Sequence[str]) -> Table:
    """Return a table of the numbers common to both directions, with formulas; a column for each limit state."""
    rows: dict[str, dict[str, Working]] = {}
    for line in (each.in_plain() for each in found.workings):
        rows.setdefault(line.symbol, {})[line.state] = line
    states = list(dict.fromkeys(state for each in rows.values() for state in each if state)) or [""]

    def of_any(value: Callable[[Working], str]) -> Callable[[Mapping[str, Working]], str]:
        return lambda each: value(next(iter(each.values())))

    def at(state: str) -> Callable[[Mapping[str, Working]], float | None]:
        return lambda each: line.value if (line := each.get(state, each.get(""))) is not None else None

    columns = [
        only_shown("", of_any(of("symbol")), text=True),
        *(only_shown(state, at(state), number) for state in states),
        only_shown("unit", of_any(of("unit")), text=True),
        only_shown("formula", of_any(of("formula")), text=True),
        only_shown("clause", of_any(cited), text=True),
    ]
    return table_of("Site", columns, [rows[symbol] for symbol in symbols or rows if symbol in rows])


def steps(workings: Sequence[Working], where: str = "") -> Iterator[Table]:
    """Yield the lines of a calculation, a table for each section; `where` names the direction."""
    for section, lines in groupby((each.in_plain() for each in workings), key=of("section")):
        yield table_of(": ".join(filter(None, (where, section))) or "Calculation", STEPS, lines)


def cited(line: Working) -> str:
    """Return the clause of a formula; with "ours" if the formula is this package's interpretation."""
    return f"{line.clause}, ours" if line.standing == "ours" else line.clause


def data(found: Verification) -> dict[str, Any]:
    """Return a verification as plain data."""
    shown_by = showing(found)
    return {
        "code": found.code,
        "edition": found.edition,
        "conclusion": conclusion_data(found.conclusion),
        "directions": {direction.label: shown_by.data(found, each) for direction, each in found.directions.items()},
        "governs": found.governs.label,
        "caution": " ".join(cautions_of(found.mechanism)) or None,
        **shown_by.data_of_all(found),
        **({} if found.strengthened is None else {"strengthened": data(found.strengthened)}),
    }


def table(found: Verification) -> Mapping[str, Sequence[Any]]:
    """Return a table as columns, with a row for each direction and method; of both structures if two are compared."""
    rows = showing(found).table(found)
    if found.strengthened is None:
        return rows
    of_both = {"existing": rows, "strengthened": showing(found).table(found.strengthened)}
    structures = [name for name, each in of_both.items() for _ in next(iter(each.values()))]
    return {"structure": structures, **{key: [*rows[key], *of_both["strengthened"][key]] for key in rows}}


def standing(workings: Sequence[Working], notation: str | None = "", say: Language = ENGLISH) -> str:
    """Return a sentence on how far the formulas were checked against the code; empty without formulas.

    `notation` is the form in which the code is cited, such as ": [formula] or §section"; None for the short form,
    which counts or names formulas by their symbols alone.
    """
    plain = [each.in_plain() for each in workings]
    ours, unchecked, transcribed, printed = (
        {each.symbol: each.meaning for each in plain if each.standing == level}
        for level in ("ours", "code", "transcription", "print")
    )
    sentences, symbols = [], {"printed": ", ".join(printed)}
    if notation is not None and (printed or transcribed or unchecked):
        sentences.append(say("standing_clauses", notation=say(notation)))
    if transcribed or unchecked:
        sentences.append(say("standing_some" if printed else "standing_none", **symbols))
    elif printed:
        sentences.append(say("standing_all"))
    if transcribed:
        but: Remark | str = ""
        if unchecked:
            names = ", ".join(unchecked)
            but = Remark.of(
                "standing_but_some" if notation is None else "standing_but", names=names, count=len(unchecked)
            )
        sentences.append(say("standing_others_agree" if printed else "standing_agree", but=but))
    if ours and notation is None:
        sentences.append(say("standing_ours", names=", ".join(ours)))
    elif ours:
        named = (f"{symbol} ({say.recognised('shown', meaning)})" for symbol, meaning in ours.items())
        sentences.append(say("standing_ours_named", names=", ".join(named)))
    return " ".join(sentences)
