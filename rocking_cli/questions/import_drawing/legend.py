"""What a drawing says of itself: unit, origin, scale, and roles of its layers; and the notes on an import."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fnmatch import fnmatchcase
from functools import lru_cache
from math import isfinite, nan
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.text import cut, in_short
from rocking_cli.units import KINDS


@dataclass(frozen=True)
class ImportNote:
    """A thing that was mended, assumed or left out.

    Parameters
    ----------
    kind : str
        Its kind, such as "joined" or "left out".
    count : int
        How many times.
    words : str
        The sentence, without a full stop.
    at : sequence of complex
        Where [units of the drawing].
    """

    kind: str
    count: int
    words: str
    at: Sequence[complex] = ()


class DrawingFrame(NamedTuple):
    """The unit and the origin of a drawing, its closing distance [m] and its file.

    Metres are (units - origin) times `per`.
    """

    per: float
    origin: complex
    close: float
    file: str

    def to_metres(self, z: Points) -> Points:
        """Return points in metres."""
        return (np.asarray(z) - self.origin) * self.per

    def to_drawing(self, z: complex) -> complex:
        """Return a point in units of the drawing."""
        return complex(z) / self.per + self.origin

    def place(self, z: complex) -> str:
        """Return a point in words, in units of the drawing."""
        at = self.to_drawing(z)
        return f"({at.real:.7g}, {at.imag:.7g})"

    def refusal(self, refused: str, message: str, at: Iterable[complex] = (), hint: str | None = None) -> DrawingError:
        """Return the error of a class, with its places [m]; `<here>` in the message is the first one, in words."""
        points = list(at)
        if points:
            message = message.replace("<here>", self.place(points[0]))
        return DrawingError(refused, message, self.file, [[z.real, z.imag] for z in map(self.to_drawing, points)], hint)


def length_in_words(metres: float) -> str:
    """Return a small length in millimetres, a larger one in metres."""
    return f"{1000 * metres:.3g} mm" if metres < 1 else f"{metres:.4g} m"


def many(count: int, name: str) -> str:
    """Return a number of things: "1 line", "2 lines"."""
    return f"{count:,} {name}{'' if count == 1 else 's'}"


MIN_SIZE, MAX_SIZE = 0.1, 100.0  # sizes between which the unit of a file is believed [m]
SAME_SIZE = 0.01  # difference from the size on paper that a scale cannot be
SHOWN = ("mm", "cm", "m")  # units in which a size without one is shown


def scale_of(text: str) -> float:
    """Return the number of a scale such as `1:50`. Raises `InputError` if it is not one."""
    match = re.fullmatch(r"\s*1\s*:\s*([0-9]+(?:\.[0-9]+)?)\s*", text)
    if match is None or not 0 < float(match[1]) <= 1e6:
        raise InputError(Problem(f"{cut(repr(text))} is not a scale", field=named("scale"), hint="write it as 1:50"))
    return float(match[1])


def metres(unit: str) -> float:
    """Return the length of a unit [m]. Raises `InputError` if it is not a unit of length."""
    units = KINDS["length"]
    if unit not in units:
        raise InputError(
            Problem(
                f"{cut(repr(unit))} is not a unit of length", field=named("units"), hint=f"one of {', '.join(units)}"
            )
        )
    return float(units[unit])


def metres_per_unit(
    drawing: LineDrawing, size: float, units: str | None, scale: str | None, file: str
) -> tuple[float, str]:
    """Return the metres to a unit of a drawing, and the words for where they come from.

    Parameters
    ----------
    drawing : LineDrawing
        The drawing.
    size : float
        Larger of width and height of what is drawn [units].
    units, scale : str or None
        As the user gives them: `mm`, `1:50`.
    file : str
        Name of the file in messages.

    Raises
    ------
    DrawingError
        Of the class "units", if they are not given, and the file states none that can be believed.
    InputError
        If `units` or `scale` are not valid.
    """
    times = scale_of(scale) if scale is not None else 1.0
    if units is not None:
        per, words = metres(units) * times, f"1 unit = 1 {units}" + (f", at {scale}" if scale else "")
        if drawing.paper is not None and abs(per / drawing.paper - 1) < SAME_SIZE:
            words += f", the size on paper (if it is drawn to a scale, give {named('scale')})"
    elif scale is not None and drawing.paper is not None:
        per, words = drawing.paper * times, f"the size on paper, at {scale}"
    elif drawing.unit is not None:
        per, words = (
            metres(drawing.unit) * times,
            f"the unit is {drawing.unit}, as stated in the file" + (f", at {scale}" if scale else ""),
        )
        if not MIN_SIZE <= size * per <= MAX_SIZE:
            what = (
                f"the file says {drawing.unit}, and what is drawn would be {size * per:.3g} m large: give "
                f"{named('units')}"
            )
            raise DrawingError("units", what, file)
    else:
        sizes = ", ".join(f"{size * metres(each):.4g} m if {each}" for each in SHOWN)
        why = drawing.doubt or f"the drawing does not say its units{' or its scale' * (drawing.paper is not None)}"
        more = f" or {named('scale')}" if drawing.paper is not None and scale is None else ""
        raise DrawingError("units", f"{why}: give {named('units')}{more} (it is {size:.4g} units large: {sizes})", file)
    if not isfinite(size * per) or not 1e-3 <= size * per <= 1e4:
        large = f"what is drawn would be {size * per:.3g} m large"
        what = f"{large}: give other {named('units')} or another {named('scale')}"
        raise DrawingError("units", what, file)
    return per, words


class Role(StrEnum):
    """What counts on a layer."""

    NOTHING = "nothing"
    HINGES = "hinges"
    LOADS = "loads"
    TIES = "ties"
    OPENINGS = "openings"
    SUPPORTS = "supports"
    GROUND = "ground"
    BODIES = "bodies"


WORDS: Mapping[Role, str] = {
    Role.NOTHING: "defpoints dim dims dimension* displaced thrust names text texts frame frames border* hatch* axis "
    "axes quota quote quotat* asse assi testo testi squadratur* cartigli* retin* tratteggi* sfond* "
    "mass masse bemass* achs* beschrift* schraff* rahmen* schriftfeld* hintergrund* "
    "cota cotas eje ejes texto* sombread* marco* cajetin* fondo* cote cotes axe texte* hachur* cadre* cartouche* fond",
    Role.HINGES: "hinge* cernier* gelenk* rotul* articulac*",
    Role.LOADS: "load loads caric* forza forze last lasten kraft krafte carga* fuerza* charge charges force forces",
    Role.TIES: "tie ties caten? tirant* zuganker* zugstab* zugstang* tensor*",
    Role.OPENINGS: "opening* hole holes window* door doors foro fori buco buchi apertur* finestr* porta porte offnung* "
    "fenster* tur turen hueco* vano vanos abertur* ventan* puert* ouvertur* fenetr* baie baies",
    Role.SUPPORTS: "support supports floor floors solai* carrell* decke decken auflager* forjad* apoyo* plancher* "
    "appui*",
    Role.GROUND: "ground soil* rock rocks terren* suolo suoli pavimento boden baugrund erdreich gelande fels suelo* "
    "roca* sol sols terrain* rocher*",
    Role.BODIES: "body bodies *block* *stone* voussoir* masonry *brick* wall walls arch arches column* pier piers "
    "buttress* vault* plinth* capital* pedestal* statue* gable* facade* corpo corpi *blocc* conci* *pietr* *murat* "
    "*matton* parament* muro muri parete pareti arco archi colonn* pilastr* piedritt* contraffort* volta volte "
    "basament* piedistall* capitell* facciat* statu* *mauer* wand bogen *gewolb* saule* pfeiler* strebepfeiler* "
    "widerlager* giebel* sockel* fassade* *stein *steine *ziegel* muros arcos *piedra* *ladrill* pilar* contrafuert* "
    "boved* estribo* sillar* dovela* estatu* fachad* mur murs arc arcs pilier* piedroit* colonne* contrefort* voute* "
    "culee* socle* piedestal* pignon* *pierre* *brique*",
}
"""Patterns of words in the names of layers, in the order in which they count: TESTO_PIETRE has texts, no stones."""


def plain(name: str) -> str:
    """Return a name in small letters and without accents."""
    parts = unicodedata.normalize("NFKD", name)
    return "".join(each for each in parts if not unicodedata.combining(each)).casefold()


@lru_cache(maxsize=4096)
def role_of(layer: str) -> Role | None:
    """Return the role that the name of a layer says; None if it says none."""
    words = re.findall(r"[^\W\d_]+", plain(layer))
    for role, patterns in WORDS.items():
        if any(fnmatchcase(word, pattern) for pattern in patterns.split() for word in words):
            return role
    return None


def parse_layers(given: Sequence[str]) -> dict[str, list[str]]:
    """Return the layers of each role from texts such as `bodies=CONCI,PILE`."""
    layers: dict[str, list[str]] = {}
    for text in given:
        role, sign, names = text.partition("=")
        if not sign or role.strip().lower() not in {*Role}:
            hint = f"write ROLE=LAYER,LAYER with a role among {', '.join(Role)}"
            raise InputError(
                Problem(f"{cut(repr(text))} is not a role and its layers", field=named("layers"), hint=hint)
            )
        layers.setdefault(role.strip().lower(), []).extend(each.strip() for each in names.split(",") if each.strip())
    return layers


@dataclass(frozen=True)
class Roles:
    """The role of each layer: as given, or by its name.

    Parameters
    ----------
    given : mapping of str to Role
        Roles that the user gives, by layer.
    """

    given: Mapping[str, Role]

    @classmethod
    def of(cls, drawing: LineDrawing, layers: Mapping[str, Sequence[str]]) -> Roles:
        """Make the roles of the layers of a drawing. Raises `InputError` if it has no layer of a given name."""
        held: list[DrawnLine | DrawnText | DrawnPoint | OmittedKind] = [
            *drawing.chains, *drawing.labels, *drawing.spots, *drawing.left_out
        ]  # fmt: skip
        known = {each.layer for each in held}
        given: dict[str, Role] = {}
        for role, names in layers.items():
            for name in names:
                alike = [each for each in known if each == name] or [
                    each for each in known if plain(each) == plain(name)
                ]
                if not alike:
                    hint = f"its layers are {in_short(sorted(known))}" if known else "it has no layers"
                    raise InputError(
                        Problem(f"the drawing has no layer {cut(repr(name))}", field=named("layers"), hint=hint)
                    )
                for each in alike:
                    if given.setdefault(each, Role(role)) != role:
                        raise InputError(Problem(f"{cut(repr(name))} has two roles", field=named("layers")))
        return cls(given)

    def __call__(self, layer: str) -> Role | None:
        """Return the role of a layer; None if neither its name nor the user says one."""
        return self.given[layer] if layer in self.given else role_of(layer)


def counted(layers: Mapping[str, int]) -> str:
    """Return how many outlines each layer has: "MURO has 3 outlines, 0 has 1"."""
    most = [name for name, _ in Counter(layers).most_common()]
    named = [f"{cut(name) or 'no layer'} has {layers[name]}" for name in most]
    first = f"{named[0]} outline{'' if layers[most[0]] == 1 else 's'}"
    return in_short([first, *named[1:]])


def proposed(layers: Mapping[str, Sequence[DrawnLine]]) -> tuple[dict[Role, list[str]], list[str]]:
    """Return the role that layers of no role may have by what is drawn on them: hatches and frames are no bodies.

    A frame is an outline around all that is drawn on other layers; with it come the layers that are taken for frames.
    """
    closed = {name: [each for each in lines if each.closed] for name, lines in layers.items()}
    boxes = {name: _box(lines) for name, lines in layers.items()}
    roles, frames = dict[Role, list[str]](), list[str]()
    for name in layers:
        (left, low, right, top), others = _box(closed[name]), [box for other, box in boxes.items() if other != name]
        if others and all(left < a and low < b and c < right and d < top for a, b, c, d in others):
            frames.append(name)
        none = name in frames or (closed[name] and all(each.is_fill for each in closed[name]))
        roles.setdefault(Role.NOTHING if none else Role.BODIES, []).append(name)
    return roles, frames


def _box(lines: Sequence[DrawnLine]) -> tuple[float, float, float, float]:
    z = np.concatenate([each.points for each in lines]) if lines else np.array([nan + 0j])
    return float(z.real.min()), float(z.imag.min()), float(z.real.max()), float(z.imag.max())
