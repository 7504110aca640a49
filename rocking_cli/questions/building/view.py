"""View of a building with its mechanisms, as text and as data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import degrees, isfinite
from operator import itemgetter
from typing import Any, NamedTuple

from rocking_cli.core.structure_file import fields_text
from rocking_cli.io.yaml_file import block
from rocking_cli.questions.building.study import (
    DAMPING,
    LATER_DAMPING,
    LENGTHENED,
    Assessed,
    BarsOfLevel,
    Found,
    LeftOutMechanism,
    floor_of,
    known_last,
)
from rocking_cli.studies.conclusion import Concluded, Effect
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, table_of
from rocking_cli.views.conclusion import conclusion_data, limit_in_words, not_counted, of_verification
from rocking_cli.views.sheet.language import Language, texts_of, translated
from rocking_cli.views.verification import showing
from rocking_cli.views.view import Aside, Table, View

PACKAGE = "rocking_cli.questions.building"
NAMED = 2  # mechanisms that a sentence names
SHOWN_ROWS = 12  # mechanisms that terminals and the first page list


class RankedMechanism(NamedTuple):
    """A mechanism with its rank, from 1, what names it, its verdict, and what governs it, in a language."""

    rank: int
    found: Found
    title: str
    verdict: str
    limits: str


def words(key: str, *, is_plain: bool = True) -> Language:
    """Return a language with the texts of buildings."""
    return Language(key, texts_of(PACKAGE, key), is_plain)


def code_words(found: Assessed, say: Language) -> Language:
    """Return a language with the texts of the code that verified a building."""
    spoken: Language = showing(found.governs.verification).in_language(say.key).say
    return spoken


def ranked(found: Assessed, say: Language) -> list[RankedMechanism]:
    """Return the mechanisms with their ranks and words."""
    spoken, rows = code_words(found, say), list[RankedMechanism]()
    for rank, each in enumerate(found.rows, 1):
        end, methods = each.conclusion, each.verification.deciding.methods
        method = methods[end.method].title if end.method in methods else "time histories"
        limits = f"{end.limit_state} {spoken(method.removesuffix(f' at {end.limit_state}'))}".strip()
        rows.append(RankedMechanism(rank, each, say(each.made.title), say(f"short_{end.concluded.value}"), limits))
    return rows


COLUMNS: Sequence[Column[RankedMechanism]] = (
    Column("rank", of("rank"), head="rank"),
    Column("title", of("title"), head="mechanism", name="mechanism", text=True),
    Column("kind", of("found.made.kind"), text=True),
    Column("wall", of("found.made.wall"), text=True),
    Column("ratio", of("found.ratio"), head="ratio"),
    Column("concluded", of("found.conclusion.concluded.value"), text=True),
    only_shown("verification", of("verdict"), text=True),
    Column("limit_state", of("found.conclusion.limit_state"), text=True),
    Column("method", of("found.conclusion.method"), text=True),
    only_shown("governs", of("limits"), text=True, rank=2),
    Column("hinge", lambda row: row.found.made.hinge[0], "m"),
    Column("top", lambda row: row.found.made.hinge[1], "m"),
    Column("shaken_at", of("found.made.z"), "m"),
    Column("crack", lambda row: None if row.found.made.angle is None else degrees(row.found.made.angle), "deg"),
)


def view(found: Assessed, designed: BarsOfLevel | None, say: Language) -> View:
    """Show the verdict on a building, its mechanisms, the worst first, and what is not verified.

    Parameters
    ----------
    found : Assessed
        The building.
    designed : BarsOfLevel, optional
        The bars that were found for its ties.
    say : Language
        The language.
    """
    rows = ranked(found, say)
    table = table_of(say("table", count=len(rows)), COLUMNS, rows)
    parts: list[Table | str] = [" ".join(verdict(found, say)), replace(table, asides=range(SHOWN_ROWS, len(rows)))]
    if found.strengthened is not None:
        parts += [compared(found, found.strengthened, say), *verdict(found.strengthened, say)]
    if designed is not None:
        title = say("designed", level=designed.level)
        columns = (
            only_shown("bars", of("diameter"), lambda diameter: f"{1000 * diameter:.0f} mm"),
            only_shown("ratio", of("ratio")),
            only_shown("mechanism", of("title"), say, text=True),
        )
        parts += [table_of(title, columns, designed.tried), *designed_in_words(designed, say)]
    parts += [*conditions(found, say), *notes(found, say)]
    return translated(say, View(lambda: data(found, designed), parts))


def verdict(found: Assessed, say: Language) -> Iterator[str]:
    """Yield the sentences of the verdict on a building."""
    worst, counts = found.governs, Counter(each.conclusion.concluded for each in found.rows)
    end, name = found.conclusion, found.building.name or say("building")
    spoken = code_words(found, say)
    yield say(f"verdict_{end.concluded.value}", name=name, site=found.site.site.name or say("the site"))
    falling = [each for each in found.left_out if each.falls]
    if falling:
        yield say("falls", mechanism=falling[0].title, why=say(falling[0].why))
    yield say("governing_others" if falling else "governing", mechanism=worst.made.title, count=len(found.rows))
    yield from of_verification(worst.verification, spoken)[1:2]
    bad = [say(f"count_{each.value}", count=counts[each]) for each in Concluded if counts[each]]
    yield say("counts", counts="; ".join(bad))
    if say.is_plain and end.concluded not in (Concluded.SATISFIED, Concluded.SATISFIED_IF):
        yield say("next_step")


def conditions(found: Assessed, say: Language) -> Iterator[str]:
    """Yield the conditions of the mechanisms that are satisfied only on conditions, each kind once."""
    of_key: dict[str, list[tuple[str, str]]] = {}
    spoken = code_words(found, say)
    for row in found.rows:
        for limit in (each for each in row.conclusion.limits if each.effect is not Effect.REPLACES):
            of_key.setdefault(limit.key, []).append((limit_in_words(limit, spoken), say(row.made.title)))
    for entries in of_key.values():
        texts = list(dict.fromkeys(text for text, _ in entries))
        mechanisms = _some(dict.fromkeys(title for _, title in entries), say)
        more = say("alike", count=len(texts) - 1) if len(texts) > 1 else ""
        yield say("condition", condition=texts[0], mechanisms=mechanisms, more=more)


def _some(names: Iterable[str], say: Language) -> str:
    """Return the first names, and how many more there are."""
    every = list(names)
    first = ", ".join(every[:NAMED])
    return say("and_more", names=first, count=len(every) - NAMED) if len(every) > NAMED else first


def notes(found: Assessed, say: Language) -> Iterator[str]:
    """Yield what is not verified, how the motion of the building was taken, and what such a verification leaves out."""
    yield from _of_rows(found, say)
    for reason, names in reasons((each for each in found.left_out if not each.open), say).items():
        yield Aside(say("not_made", names=_some(names, say), why=reason))
    if any(row.made.z > 0 for row in found.rows) and getattr(found.site.site, "floor", None) is None:
        source = say("period_given" if found.period_given else "period_formula", T=found.period)
        damped = {"xi": 100 * LATER_DAMPING, "first": 100 * DAMPING}
        later = {"T": LENGTHENED * found.period, "factor": LENGTHENED, **damped}
        yield say("period", source=source, **later)
    if found.strengthened is not None:
        for text in (*conditions(found.strengthened, say), *_of_rows(found.strengthened, say)):
            yield say("of_strengthened", text=text)
    if found.building.masonry.crushing is None:
        yield say("unlimited")
    yield say("covers")


def reasons(left_out: Iterable[LeftOutMechanism], say: Language) -> dict[str, list[str]]:
    """Return the names of mechanisms that are not verified, by the reason."""
    of: dict[str, list[str]] = {}
    for each in left_out:
        of.setdefault(say(each.why), []).append(say(each.title))
    return of


def _of_rows(found: Assessed, say: Language) -> Iterator[str]:
    """Yield what could not be verified, what structures leave out, and which motions were followed and count."""
    for reason, names in reasons((each for each in found.left_out if each.open), say).items():
        yield say("open", name=", ".join(names), why=reason)
    for row in found.rows:
        for remark in row.made.remarks:
            yield f"{say(row.made.title)}: {say(remark)}."
    if rows := [row for row in found.rows if row.made.name in found.shaken]:
        yield say(
            "shaken", outcomes="; ".join(": ".join([say(row.made.title), *_of_histories(row, say)]) for row in rows)
        )
        if len(rows) < len(found.rows):
            yield say("shaken_others")
        left_out = dict.fromkeys(each for row in rows for each in row.conclusion.left_out if each.what == "motion")
        yield from not_counted([*left_out], code_words(found, say))


def _of_histories(row: Found, say: Language) -> Iterator[str]:
    """Yield the outcome of the time histories of a mechanism, in its worse direction; nothing of too few records."""
    checks = [each for side in row.verification.directions.values() for each in side.checks if each.motions]
    worst = {each.state: each for each in sorted(checks, key=lambda each: -(each.ratio or 0.0))}
    outcomes = []
    for state, each in worst.items():
        verdict = say(f"short_{each.concluded.value}")
        known = {"ratio": each.ratio} if each.ratio is not None and isfinite(each.ratio) else {}
        key = "shaken_by" if known else "shaken_unknown"
        outcomes.append(say(key, state=state, count=len(each.motions), verdict=verdict, **known))
    if outcomes:
        yield ", ".join(outcomes)


def compared(found: Assessed, other: Assessed, say: Language) -> Table:
    """Return the least ratio of each kind of mechanism of each wall in both buildings."""
    least: dict[tuple[str, str], dict[bool, float]] = {}
    for after, rows in enumerate((found.rows, other.rows)):
        for row in rows:
            of_both = least.setdefault((row.made.wall, row.made.kind), {})
            of_both[bool(after)] = min(row.ratio, of_both.get(bool(after), row.ratio), key=known_last)
    cells = [(wall, say(f"kind_{kind}"), both.get(False), both.get(True)) for (wall, kind), both in least.items()]
    heads = ("wall", "kind", "existing", "strengthened")
    columns = [only_shown(head, itemgetter(k), text=k < 2) for k, head in enumerate(heads)]
    return table_of(
        say("compared"), columns, sorted(cells, key=lambda row: known_last(row[3] if row[2] is None else row[2]))
    )


def designed_in_words(found: BarsOfLevel, say: Language) -> Iterator[str]:
    """Yield which bars suffice for the ties of a level, and what governs the building with them."""
    last, level = found.tried[-1], found.level
    yield say(f"bars_{last.concluded.value}", level=level, diameter=1000 * last.diameter, name=last.title)
    if found.whole.concluded not in (Concluded.SATISFIED, Concluded.SATISFIED_IF):
        yield say("still", name=found.governs, verdict=say(f"short_{found.whole.concluded.value}"))


def data(found: Assessed, designed: BarsOfLevel | None) -> dict[str, Any]:
    """Return a building with its mechanisms as plain data."""
    mechanisms, english = list[dict[str, Any]](), words("en")
    for row in ranked(found, english):
        made = row.found.made
        structure = {"mechanism": made.mechanism, "name": made.name, **made.fields}
        end = conclusion_data(row.found.conclusion)
        mechanisms.append({**data_of(COLUMNS, row), "conclusion": end, "structure": structure})
    plain: dict[str, Any] = {
        "building": found.building.name, "site": found.site.site.name, "conclusion": conclusion_data(found.conclusion),
        "governs": found.governs.made.name, "mechanisms": mechanisms,
        "T1": None if getattr(found.site.site, "floor", None) is not None else found.period,  # that of the floor counts
        "left_out": [{"title": english(each.title), "why": english(each.why), "open": each.open, "falls": each.falls}
            for each in found.left_out
        ],
        "shaken": list(found.shaken),
    }  # fmt: skip
    if designed is not None:
        tried = [{**each._asdict(), "title": english(each.title)} for each in designed.tried]
        ends = {"conclusion": conclusion_data(designed.whole), "governs": english(designed.governs)}
        plain["designed"] = {"level": designed.level, "diameter": designed.diameter, "tried": tried, **ends}
    if found.strengthened is not None:
        plain["strengthened"] = data(found.strengthened, None)
    return plain


def columns(found: Assessed, say: Language) -> Mapping[str, Sequence[Any]]:
    """Return a table of the mechanisms as columns."""
    return frame_of(COLUMNS, ranked(found, say))


def file_of(found: Found) -> str:
    """Return the text of the structure file of a mechanism."""
    made = found.made
    above = (
        f"{made.name}, from {made.hinge[0]:.4g} to {made.hinge[1]:.4g} m above the foundation",
        f"shaken by the building at {made.z:.4g} m: the site beside it has this height",
    )
    return fields_text(made.mechanism, {"name": made.name, **made.fields}, above)


def site_file(found: Assessed, z: float) -> str:
    """Return the text of the site file of what is shaken at a height above the foundation [m]."""
    site: Any = floor_of(found.building, found.site, z).site
    fields = dict(found.site.document.data)
    if fields.pop("grid", None) is not None:  # its path is that of another folder
        fields = {key: each for key, each in fields.items() if key not in ("longitude", "latitude")}
        fields["hazard"] = [list(row) for row in site.hazard]
    fields.pop("floor", None)
    if site.floor is not None:
        fields["floor"] = site.floor.model_dump(exclude_unset=True, exclude_none=True)
    return "\n".join([line for key, value in fields.items() for line in block(key, value)] + [""])
