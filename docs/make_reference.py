"""What the site has from the code alone: command line, JSON, fields of mechanisms and studies, Python names."""

from __future__ import annotations

from enum import Enum
from inspect import Parameter, cleandoc, getdoc, isclass, signature
from pathlib import Path
from pkgutil import resolve_name
from textwrap import dedent, indent
from types import ModuleType
from typing import Any, is_typeddict

import click
import make_chooser
from parts import HERE
from pydantic import BaseModel

import rocking_cli
from rocking_cli import Registry, core, verification
from rocking_cli.ask.asked import told_of
from rocking_cli.cli.help import RECORDS_HEADING, heading_of
from rocking_cli.cli.main import main
from rocking_cli.processing.intensity import IntensityMeasures, power_of
from rocking_cli.questions.fragility.asked import OfStudy
from rocking_cli.questions.fragility.definition import Definition
from rocking_cli.verification import Code
from rocking_cli.views.mechanisms import fields

API = Path(__file__).resolve().parent / "api"
PROJECT = Path(__file__).resolve().parent.parent
EXAMPLES = PROJECT / "examples"
LANGUAGES = {".yaml": "yaml", ".py": "python", ".toml": "toml"}


def command_line() -> str:
    """Return usage, help and options of the group and of every command; options of records come once, at the end."""
    group = click.Context(main, info_name="rocking", **main.context_settings)
    parts = [described(main, group)]
    of_records: dict[str, str] = {}
    for name in main.list_commands(group):
        command = main.get_command(group, name)
        assert command is not None
        ctx = click.Context(command, group, info_name=name)
        parts.append(f"## rocking {name}\n\n" + described(command, ctx))
        of_records |= listed(command, ctx, of_records=True)
    parts += [
        f"## {RECORDS_HEADING}",
        "Each command above names those of these options that it has.",
        bullets(of_records),
    ]
    return "\n\n".join(parts) + "\n"


def described(command: click.Command, ctx: click.Context) -> str:
    """Usage, help and options of a command, in Markdown."""
    usage = f"    {ctx.command_path} {' '.join(command.collect_usage_pieces(ctx))}"
    return "\n\n".join([usage, *map(paragraph, cleandoc(command.help or "").split("\n\n")), options(command, ctx)])


def paragraph(text: str) -> str:
    r"""Return a paragraph of a help text; one that begins with click's \b keeps its lines, below its heading."""
    if not text.startswith("\b"):
        return plain(" ".join(text.split()))
    _, heading, *lines = text.split("\n")
    return f"{plain(heading)}\n\n" + indent(dedent("\n".join(lines)), "    ")


def options(command: click.Command, ctx: click.Context) -> str:
    """Return a list of the entries of `--help`, and the names of the options of records."""
    found = bullets(listed(command, ctx, of_records=False))
    names = [f"`{each.split()[0]}`" for each in listed(command, ctx, of_records=True)]
    link = f"[{RECORDS_HEADING}](#{RECORDS_HEADING.lower().replace(' ', '-')})"
    return found + (f"\n\n{link}: {', '.join(names)}." if names else "")


def listed(command: click.Command, ctx: click.Context, *, of_records: bool) -> dict[str, str]:
    """Return the meanings of the options under one heading of `--help`, by their names."""
    wanted = (each for each in command.get_params(ctx) if isinstance(each, click.Option))
    found = (each.get_help_record(ctx) for each in wanted if (heading_of(each) == RECORDS_HEADING) == of_records)
    return dict(each for each in found if each is not None)


def bullets(meanings: dict[str, str]) -> str:
    """Return a list of options and their meanings."""
    return "\n".join(f"- `{names}`: {plain(meaning)}" for names, meaning in meanings.items())


def plain(text: str) -> str:
    """Text that Markdown leaves as it is; code stays code."""
    pieces = text.split("`")
    for k in range(0, len(pieces), 2):
        for sign in "\\*_<[$":
            pieces[k] = pieces[k].replace(sign, "\\" + sign)
    return "`".join(pieces)


def mechanism(cls: Any) -> str:
    """Source and verification, and fields."""
    return (
        f"**Source:** {plain(cls.source)}.\n\n**Verified against:** {plain(cls.verified or 'nothing yet')}.\n\n"
        + (f"**Caution:** {plain(cls.caution)}\n\n" if cls.caution else "")
        + f"## Fields\n\n{table_of_fields(cls)}"
    )


def table_of_fields(cls: Any) -> str:
    """Return the fields of a mechanism, and the names of those that all mechanisms have."""
    rows = ["| field | meaning | symbol | unit | bounds | default |", "|---|---|---|---|---|---|"]
    for row in fields(cls):
        if not row["common"]:
            default = "required" if row["required"] else "" if row["default"] is None else f"`{row['default']}`"
            words = (plain(row[key]) for key in ("description", "symbol", "unit", "bounds"))
            rows.append(f"| `{row['field']}` | {' | '.join(words)} | {default} |")
    common = ", ".join(f"`{row['field']}`" for row in fields(cls) if row["common"])
    return "\n".join(rows) + f"\n\nand {common}, see [what is common to all](../structures.md)."


def study_fields() -> str:
    """Return the fields of a study file."""
    rows = ["| field | what it is | default |", "| --- | --- | --- |"]
    for name, field in OfStudy.model_fields.items():
        key, told, value = "records" if name == "motions" else name, told_of(field), field.default
        default = ", ".join(value) if isinstance(value, list) else "" if value is None else str(value)
        default = "required" if Definition.model_fields[key].is_required() else told.usual or default
        rows.append(f"| `{key}` | {plain(str(field.description))} | {plain(default)} |")
    return "\n".join(rows)


def names_of(page: str) -> list[str]:
    """Return the names that a page of the Python reference documents, those of other modules with their modules."""
    return [name for part in HERE.finditer(page_of(page)) if part["kind"] == "names" for name in part["what"].split()]


def page_of(page: str) -> str:
    """Return the text of a page of the Python reference."""
    return (API / f"{page}.md").read_text(encoding="utf-8")


def index(pages: str) -> str:
    """Return tables of all names of pages of the Python reference, each of which leads to its text."""
    lines = []
    for page in pages.split():
        title = page_of(page).partition("\n")[0].removeprefix("# ")
        lines += ["", f"## [{title}](api/{page}.md)", "", "| name | what it is |", "|---|---|"]
        for name in names_of(page):
            first = plain(summary(resolve_name(f"rocking_cli.{name}"))).replace("|", "\\|")
            lines.append(f"| {{py:obj}}`{name.rpartition('.')[2]} <rocking_cli.{name}>` | {first} |")
    return "\n".join(lines)


def summary(each: Any) -> str:
    """Return the first sentence of a docstring."""
    return " ".join((getdoc(each) or "").split("\n\n")[0].split())


def helpers(names: str, module: ModuleType = core) -> str:
    """Return signature and first sentence of names of `rocking_cli.core`, or a module.

    With a dot, a method that `Mechanism` has: `.bodies`.
    """
    lines = []
    for name in names.split():
        each = getattr(core.Mechanism, name[1:]) if name[0] == "." else resolve_name(f"{module.__name__}.{name}")
        lines.append(f"- `{called(name.lstrip('.'), each)}`: {plain(summary(each))}")
    return "\n".join(lines)


def called(name: str, each: Any) -> str:
    """Return a function or a class as it is called, with types and defaults of its arguments."""
    if isclass(each) and issubclass(each, Enum):
        return ", ".join(f"{name}.{member}" for member in each.__members__)
    taken, returned = typed(each)
    return f"{name}{taken}{returned and f' -> {returned}'}"


def typed(each: Any) -> tuple[str, str]:
    """Return the arguments of a function or a class in brackets, and what a function returns; empty for a property."""
    is_called = callable(each) and not getattr(each, "_is_protocol", False) and not is_typeddict(each)
    if not is_called or (isclass(each) and issubclass(each, BaseModel | Code | Enum | Exception)):
        return "", ""
    found = signature(each)
    given = [one for one in found.parameters.values() if one.name != "self"]
    kinds = [one.kind for one in given]
    taken = [argument(one) for one in given]
    if Parameter.KEYWORD_ONLY in kinds and Parameter.VAR_POSITIONAL not in kinds:
        taken.insert(kinds.index(Parameter.KEYWORD_ONLY), "*")
    return f"({', '.join(taken)})", "" if isclass(each) else kind(found.return_annotation)


def argument(one: Parameter) -> str:
    """An argument as it is written where a function is defined."""
    stars = {Parameter.VAR_POSITIONAL: "*", Parameter.VAR_KEYWORD: "**"}.get(one.kind, "")
    default = "..." if repr(one.default).startswith("<") else repr(one.default)
    return f"{stars}{one.name}: {kind(one.annotation)}{'' if one.default is Parameter.empty else f' = {default}'}"


def kind(annotation: Any) -> str:
    """Return the annotation of an argument as its author wrote it."""
    return annotation if isinstance(annotation, str) else getattr(annotation, "__forward_arg__", str(annotation))


def equivalent_blocks(names: str) -> str:
    """Return the equivalent blocks of example structures, one line for each direction that differs."""
    rows = ["| structure | direction | lambda | phi\\_cr \\[rad] | p \\[rad/s] | eta |", "|---|---|---|---|---|---|"]
    for name in names.split():
        structure = rocking_cli.load_structure(EXAMPLES / f"{name}.yaml")
        blocks = core.equivalent_block(structure)
        for direction in structure.directions:
            block = blocks[direction]
            values = (block.lambda_, block.phi_cr, block.p, block.eta)
            row = f" | {' | '.join(f'{value:.4g}' for value in values)} |"
            if direction is not structure.directions[0] and rows[-1].endswith(row):
                rows[-1] = f"| {structure.name} | both{row}"
            else:
                rows.append(f"| {structure.name} | {direction.label}{row}")
    return "\n".join(rows)


def made(kind: str, what: str) -> str:
    """Return what a marker on a page stands for."""
    each = {
        "mechanism": lambda: mechanism(Registry()[what]),
        "blocks": lambda: equivalent_blocks(what),
        "core": lambda: helpers(what),
        "verification": lambda: helpers(what, verification),
        "names": lambda: docstrings(what),
        "index": lambda: index(what),
        "chooser": lambda: make_chooser.listed(what),
        "study": study_fields,
        "measures": measures,
        "formulas": standing_of_formulas,
        "readme": lambda: of_the_readme(what),
        "file": lambda: file_of(what),
    }
    return each[kind]()


def of_the_readme(name: str) -> str:
    """Return the text of the README between `<!-- NAME -->` and `<!-- /NAME -->`."""
    before, _, _ = (PROJECT / "README.md").read_text(encoding="utf-8").partition(f"<!-- /{name} -->")
    return before.rpartition(f"<!-- {name} -->")[2].replace("](docs/", "](")


def file_of(name: str) -> str:
    """Return a file of the project as a block of code."""
    return f"```{LANGUAGES[Path(name).suffix]}\n{(PROJECT / name).read_text(encoding='utf-8').strip()}\n```"


def measures() -> str:
    """Return a table of the intensity measures: how each is written, its definition, unit, and how it scales."""
    rows = ["| measure | definition | unit | scales with |", "|---|---|---|---|"]
    for each in IntensityMeasures().values():
        scales = {0.0: "nothing", 1.0: "the factor", 2.0: "its square", None: "each run"}[power_of(each)]
        told = summary(each) + (f" {each.source}." if each.source else "")
        rows.append(f"| `{each.form()}` | {plain(told)} | {each.unit} | {scales} |")
    return "\n".join(rows)


def docstrings(names: str) -> str:
    """Return the full documentation of names, for Sphinx."""
    lines = ["```{eval-rst}"]
    for name in (f"rocking_cli.{each}" for each in names.split()):
        each = resolve_name(name)
        kind = "function" if not isclass(each) else "exception" if issubclass(each, Exception) else "class"
        lines += [f".. auto{kind}:: {name}", "   :members:" * (kind == "class")]
    return "\n".join([*lines, "```", ""])


SAMPLES = {
    "state": "SLV", "on": "SLV", "at": "T", "k": "1", "axis": "x", "more": "", "P": "Σ P", "P+Q": "Σ (P+Q)",
    "over": "sumPy' + L", "under": "sum(P+Q)x'", "share": "0.4", "ends": "d_[t]; d_[a]", "a": "a^[*]",
    "bounds": "d_[Z]; d_[g]; d_[b]", "asked": "a_[g] demand",
}  # fmt: skip
"""What the slots of a formula hold in the table of formulas; others hold their own names."""
SYMBOLS = {
    "alpha": "alpha", "S_eZ": "S_[eZ](T)", "S_De": "S_[De](T)", "S_De_long": "S_[De](T)", "S_De_ground": "S_[De](T)",
    "": "d", "zeta": "a_[g]", "TR_capacity": "a_[g]",
}  # fmt: skip
"""Symbols of formulas that have several, by their meanings."""
STANDING = {
    "print": "the print",
    "transcription": "a transcription",
    "code": "not yet",
    "ours": "our reading or choice",
}


class _Slots(dict[str, str]):
    def __missing__(self, name: str) -> str:
        return name


def standing_of_formulas() -> str:
    """Return a table of the formulas of the Italian code: clause, formula, and what it was checked against."""
    from rocking_cli.codes.italian import formulas
    from rocking_cli.verification.results import Formula, Working

    def written(each: Formula) -> Working:
        slots = _Slots(SAMPLES, symbol=SYMBOLS.get(each.meaning, "symbol"))
        text = {key: getattr(each, key).format_map(slots) for key in ("symbol", "text")}
        return Working(text["symbol"], "", text["text"], "", 0.0, "", each.clause, each.standing).in_plain()

    every = [each for each in vars(formulas).values() if isinstance(each, Formula)] + [*formulas.PERIOD.values()]
    every = [each for each in every if each.clause and each.standing != "plain" and each.text not in ("", "given", "1")]
    rows = []
    for formula, line in zip(every, map(written, every), strict=True):
        text = f"{line.symbol}{' =' if formula.numbers else ':'} {line.formula}".replace("|", r"\|")
        rows.append(f"| {line.clause} | `{text}` | {STANDING[line.standing]} |")
    return "\n".join(["| clause | formula | checked against |", "|---|---|---|", *dict.fromkeys(rows)])
