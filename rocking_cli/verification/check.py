"""Verification of a structure by the code that a site file names."""

from __future__ import annotations

from dataclasses import replace
from numbers import Real
from pathlib import Path

from pydantic import ValidationError

from rocking_cli.core import Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.plausible import OddNumber, questions
from rocking_cli.dynamics.resting import early_failures, glued
from rocking_cli.errors import InputError, PluginError, Problem, named
from rocking_cli.io.yaml_file import Document, parse, placed, read_text
from rocking_cli.plugins.errors import blame
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Effect, LeftOut
from rocking_cli.studies.file_part import problems_of
from rocking_cli.studies.remark import Remark
from rocking_cli.text import did_you_mean
from rocking_cli.verification.code import DEFAULT_CODE, SITE_HINT, Code, SiteFile, codes
from rocking_cli.verification.demand import SiteDemand
from rocking_cli.verification.results import Control, Histories, Verification, Verified

EFFECTS = {"glued": Effect.CONDITION, "bonded": Effect.UNDECIDED, "unusual": Effect.CONDITION,
           "no_floor": Effect.CONDITION}  # fmt: skip
"""What the remarks made here, whatever the code, do to the conclusion; those of a code are in its own table."""


def read_site(path: Path) -> SiteFile:
    """Read a site file, for any installed code. Raises `InputError` with every problem of the file."""
    return site_in(parse(read_text(path, "site"), str(path), "site", SITE_HINT))


def site_in(document: Document, folder: Path | None = None) -> SiteFile:
    """Return the site in a parsed file.

    Parameters
    ----------
    document : Document
        The file.
    folder : Path, optional
        Folder of the files that it names; by default its own.

    Raises
    ------
    InputError
        With every problem of the file: place, field, and valid values.
    """
    code = document.data.get("code", DEFAULT_CODE)
    if isinstance(code, str) and code not in codes():
        problem = document.at(("code",), f"there is no code {code!r}", did_you_mean(code, list(codes())))
        raise InputError(*document.problems, problem)
    code = code if isinstance(code, str) else DEFAULT_CODE
    model, site = codes()[code].site, None
    lister = (
        SITE_HINT if code == DEFAULT_CODE else f"`rocking new site` prints one to start from, if given the code {code}"
    )
    try:
        site = model.model_validate(document.data)
    except ValidationError as error:
        document.problems += problems_of(document, model, error, owner="the site", lister=lister)
    document.check()
    assert site is not None  # a file without a valid site was refused
    file = SiteFile(site, document)
    try:
        return replace(file, site=codes()[code].located(site, folder or Path(document.file).parent))
    except InputError as error:
        raise file.placed(error) from None


def code_of(site: SiteFile) -> Code:
    """Return the code that a site names."""
    return codes()[site.site.code]


def of_each(site: SiteFile) -> SiteFile:
    """Return the site for a survey, without data of the structure itself, which are left to each row."""
    return replace(site, site=code_of(site).of_each(site.site))


def demand(site: SiteFile) -> SiteDemand:
    """Return the response spectra of a site by its code.

    Raises
    ------
    InputError
        If the code has none, or the site lacks values for them.
    """
    code = code_of(site)
    if not code.has_demand:
        hint = "give the file of a spectrum, or a site of a code that has them"
        raise InputError(Problem(f"{code.key} has no response spectra of a site", site.document.file, hint=hint))
    try:
        answer = code.demand(site.site)
    except InputError as error:
        raise site.placed(error) from None
    if not isinstance(answer, SiteDemand) or answer.first not in answer.states:
        raise PluginError(f"the code {code.key} failed in demand: it must return a SiteDemand with its first state")
    return answer


def row_numbers(verification: Verification, code: Code) -> dict[str, float | None]:
    """Return the numbers of a verification that a survey shows, by name; None if the site lacks values for one."""
    numbers, verified = dict[str, float | None](), verification.deciding
    for name, number in code.row_numbers.items():
        with blame(f"the code {code.key} failed in its number {name}", type(code).__module__):
            numbers[name] = number.of(verified) if number.of is not None else None
    return numbers


def refuse(site: SiteFile, *, control: bool = False, motions: bool = False) -> None:
    """Raise `InputError` if the code of a site takes no control point, or no ground motions, but there are some."""
    code = code_of(site)
    if control and not code.takes_control:
        raise InputError(Problem(f"{code.key} takes no control point", field=named("control"), hint="leave it out"))
    if motions and not code.takes_motions:
        hint = "leave out the ground motions"
        raise InputError(Problem(f"{code.key} has no method with time histories", hint=hint))


def questioned(structure: Structure, site: SiteFile) -> list[OddNumber]:
    """Return what is unusual of masonry about a structure and a site, if the code of the site is for masonry.

    Raises `InputError` with what is not possible, unless the files say that it is meant.
    """
    if not code_of(site).masonry:
        return []
    fields, odd = type(structure.mechanism).model_fields, questions(structure.mechanism, site.site)
    if impossible := [each for each in odd if each.impossible]:
        raise site.placed(InputError(*(
            placed(Problem(each.words, structure.file if each.name.partition(".")[0] in fields else None,
                           field=each.name, hint=f"if it is meant, add `unusual: [{each.name}]`"))
            for each in impossible
        )))  # fmt: skip
    return odd


def verify(structure: Structure, site: SiteFile, control: Control | None = None) -> Verification:
    """Verify a structure by the code of a site, by its static methods.

    Parameters
    ----------
    structure : Structure
        The structure.
    site : SiteFile
        The site.
    control : Control, optional
        The control point; by default that of the code.

    Raises
    ------
    InputError
        If the site lacks values that the structure needs, or the structure has no capacity curve.
    MechanismError
        If the structure does not stand.
    """
    refuse(site, control=control is not None)
    unusual = questioned(structure, site)
    structure.ask("verification")
    structure.statics  # noqa: B018 - what does not stand, or jumps, is refused with its name
    code = code_of(site)
    taken = {"control": control} if code.takes_control else {}
    try:
        mechanism = structure.mechanism.at_strength()
        verification = _held(code.verify(mechanism, site.site, **taken), code, "verify")
        before = {each.failure.joint: 0 for each in early_failures(mechanism) if each.direction in mechanism.directions}
        starts_first = [LeftOut("mechanism", joint, "starts_first") for joint in before]
        left_out = [*verification.left_out, *starts_first]
        remarks = [*_of_glue(mechanism), *verification.remarks]
        remarks += [Remark.of("no_floor" if each.name == "floor" else "unusual", what=each.name) for each in unusual]
        return replace(verification, left_out=left_out, remarks=remarks, effects={**verification.effects, **EFFECTS})
    except InputError as error:
        mechanism_fields = type(structure.mechanism).model_fields
        of_site = site.placed(error).problems
        raise InputError(
            *(
                placed(replace(each, file=structure.file))
                if each.file is None and each.field in {*mechanism_fields, "mechanism"}
                else each
                for each in of_site
            )
        ) from None


def _of_glue(mechanism: Mechanism) -> list[Remark]:
    """Return a remark on joints that need more friction than is usual, with what starts first without it."""
    first = min(glued(mechanism), key=lambda each: each.failure.push, default=None)
    if first is None:
        return []
    starts = {"usual": MASONRY_FRICTION, "push": first.failure.push / mechanism.gravity, "lambda_": first.lambda_}
    return [Remark("bonded" if first.needed is None else "glued", {"needed": first.needed, **starts})]


def _held(answer: object, code: Code, method: str) -> Verification:
    """Return an answer of a code if it is valid; anything else that a plugin returns is an error of the plugin."""
    failed = f"the code {code.key} failed in {method}"
    with blame(failed, type(code).__module__):
        if isinstance(answer, Verification) and answer.directions and all(map(_is_whole, answer.directions.values())):
            return answer
    raise PluginError(
        f"{failed}: it must return a Verification with at least one direction, each governed by one of its methods"
    )


def _is_whole(each: Verified) -> bool:
    """Return whether a direction is governed by one of its methods, and has a valid ratio and verdict."""
    return each.governs in each.methods and isinstance(each.ratio, Real | None) and each.passed in (None, True, False)


def with_histories(
    verification: Verification, structure: Structure, site: SiteFile, histories: Histories
) -> Verification:
    """Return a verification with time histories under a set of records.

    Parameters
    ----------
    verification : Verification
        The verification by the static methods.
    structure : Structure
        The structure.
    site : SiteFile
        The site.
    histories : Histories
        The records, with their polarities and limit state.

    Raises
    ------
    InputError
        If the code has no method with time histories, there is no motion, the site lacks the limit state or a floor on
        which the motions could be, or the restitution is not valid for a time history.
    SolverError
        If a motion cannot be simulated to its end.
    """
    refuse(site, motions=True)
    code = code_of(site)
    return _held(code.with_histories(verification, structure, site.site, histories), code, "with_histories")
