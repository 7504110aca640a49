"""What the layers of a drawing mean: by their names, or as the user says."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fnmatch import fnmatchcase
from functools import lru_cache
from math import nan

import numpy as np

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.drawings.contract import DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.text import cut, in_short


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
