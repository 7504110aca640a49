"""No boundary is taken for physics: random structures with every bound of the code as it is, and doubled.

`make bounds` prints what became of them; CASES and FREE in the environment are how many, and how many by free blocks.
The bounds are the numeric constants of `LAYERS`; `bounds.toml` has a line for each. A process that is to double some
rewrites them in the source as it imports it, so that defaults and what is derived of them follow.
"""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from importlib.machinery import PathFinder, SourceFileLoader
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

PROJECT = Path(__file__).resolve().parents[1]
LISTED = Path(__file__).with_suffix(".toml")
LAYERS = ("core", "dynamics", "studies", "structure.py", "names.py", "processing", "mechanisms")
KERNELS = tuple(f"rocking_cli.dynamics.{name}" for name in ("openings", "stepping", "kernels", "pulse_motion"))
NEIGHBOURS = 20
SURE = (0.05, 0.95)  # shares of overturning neighbours below and above which a verdict is sure
LEEWAY = 0.1  # by which a share must move to have changed: two neighbours of twenty
AROUND = (1.0, 0.97, 1.03)  # scales at which free blocks must contradict a verdict to refute it
AT_ONCE = 2  # processes
OPPOSITE = ("stands", "overturns")
BROKEN = ("FAILED", "the process ended")  # how the words begin with which a case has no answer


def modules() -> Iterator[tuple[str, Path]]:
    """The modules of the layers, and their files."""
    roots = [PROJECT / ("mechanisms" if name == "mechanisms" else f"rocking_cli/{name}") for name in LAYERS]
    for root in roots:
        for path in sorted(root.rglob("*.py")) if root.is_dir() else [root]:
            yield ".".join(path.relative_to(PROJECT).with_suffix("").parts).removesuffix(".__init__"), path


def constants(tree: ast.Module) -> Iterator[ast.Assign | ast.AnnAssign]:
    """The assignments of constants that are numbers, or tuples of them, written as such."""
    for node in tree.body:
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if isinstance(target, ast.Name) and target.id.strip("_").isupper() and node.value and _numeric(node.value):
            yield node


def _numeric(value: ast.expr) -> bool:
    if isinstance(value, ast.Constant):
        return isinstance(value.value, (int, float)) and not isinstance(value.value, bool)
    if isinstance(value, ast.BinOp | ast.UnaryOp | ast.Tuple):
        return all(_numeric(each) for each in ast.iter_child_nodes(value) if isinstance(each, ast.expr))
    return isinstance(value, ast.Attribute) and value.attr == "pi"


def names() -> list[str]:
    """The constants of the code, by module and name."""
    return [
        f"{module}.{ast.unparse(node.targets[0] if isinstance(node, ast.Assign) else node.target)}"
        for module, path in modules()
        for node in constants(ast.parse(path.read_text(encoding="utf-8")))
    ]


def listed() -> dict[str, dict[str, str]]:
    """The lines of the list: constants and reasons, by kind."""
    return tomllib.loads(LISTED.read_text(encoding="utf-8"))


def doubled(value: Any) -> Any:
    """Twice a number, or twice its distance to 1 where it is a share above a half."""
    if isinstance(value, tuple):
        return tuple(map(doubled, value))
    return 1 - 2 * (1 - value) if 0.5 < value < 1 else 2 * value


class _Doubling(SourceFileLoader):
    """Read a module with some constants doubled."""

    chosen: frozenset[str] = frozenset()

    def source_to_code(self, data: Any, path: Any, **how: Any) -> Any:  # type: ignore[override]
        tree = ast.parse(data)
        for node in constants(tree):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            if f"{self.name}.{ast.unparse(target)}" in self.chosen:
                call = f"__import__('tests.bounds', fromlist=['_']).doubled({ast.unparse(node.value or target)})"
                node.value = ast.parse(call, mode="eval").body
        return super().source_to_code(ast.unparse(tree).encode(), path, **how)

    def get_code(self, fullname: str) -> Any:
        return self.source_to_code(self.get_data(self.get_filename(fullname)), self.get_filename(fullname))


def double(chosen: Sequence[str]) -> None:
    """Have the modules of these constants read with them doubled, from now on."""
    _Doubling.chosen = frozenset(chosen)
    touched = {name.rpartition(".")[0] for name in chosen}

    class Finder(PathFinder):
        @classmethod
        def find_spec(cls, fullname: str, path: Any = None, target: Any = None) -> Any:
            spec = super().find_spec(fullname, path, target) if fullname in touched else None
            if spec is not None:
                spec.loader = _Doubling(fullname, str(spec.origin))
            return spec

    sys.meta_path.insert(0, Finder)
    if touched & set(KERNELS):  # machine code has them as they are
        _by_numba()


def _by_numba() -> None:
    from importlib import import_module

    sys.path.insert(0, str(PROJECT / "scripts"))
    from by_numba import compiled

    from rocking_cli.dynamics import ways
    from rocking_cli.dynamics.calling import SETS

    made = {each.module: compiled(import_module(each.module)) for each in SETS.values()}
    ways._chosen = lambda: ("numba", {name: made[each.module][each.function] for name, each in SETS.items()})


class Case(NamedTuple):
    """A structure as a user has it, and a motion: `ask` is of `rk.respond`."""

    kind: str
    fields: dict[str, Any]
    ask: dict[str, Any]


def _box(left: float, right: float, low: float, high: float) -> dict[str, Any]:
    corners = [[left, low], [right, low], [right, high], [left, high]]
    return {"polygon": [[round(x, 4), round(y, 4)] for x, y in corners]}


class _Dice(Random):
    def of(self, low: float, high: float) -> float:
        return round(self.uniform(low, high), 3)


Made = tuple[dict[str, Any], float]
"""Fields, and about at which horizontal acceleration, in g, it uplifts."""


def _assembly(blocks: dict[str, Any], lam: float, **ground: Any) -> Made:
    return {"mechanism": "assembly", "blocks": blocks, "ground": {"floor": _box(-6, 6, -0.5, 0), **ground}}, lam


def _block(dice: _Dice) -> Made:
    width, height = dice.of(0.3, 1), dice.of(1, 4)
    fields = {"mechanism": "block", "width": width, "height": height}
    if dice.random() < 0.2:
        fields |= {"one_sided": dice.choice(["positive", "negative"]), "rebound": dice.of(0, 0.5)}
    if dice.random() < 0.2:
        fields["loads"] = [{"name": "load", "mass": dice.of(100, 900), "at": [0.0, height]}]
    if dice.random() < 0.2:
        side = dice.choice([-1, 1])
        ends = {"from": {"ground": [side * 3.0, height]}, "to": {"at": [side * width / 2, height]}}
        bar = {"area": 2e-4, "modulus": 210e9, "yield_stress": 235e6}
        kind = dice.choice([bar, {"stiffness": dice.of(1e4, 1e6), "only": "tension"}])
        fields["ties"] = [{"name": "tie", **ends, **kind}]
    return fields, width / height


def _rigid_body(dice: _Dice) -> Made:
    width, height, lean = dice.of(0.4, 1.2), dice.of(1, 4), dice.of(-0.1, 0.2)
    corners = [[0.0, 0.0], [width, 0.0], [width + lean / 2, height], [lean, height]]
    return {"mechanism": "rigid_body", "polygon": corners}, width / height


def _cone(dice: _Dice) -> Made:
    radius, height = dice.of(0.3, 1.5), dice.of(2, 8)
    return {"mechanism": "cone", "base_radius": radius, "height": height, "kind": "solid"}, 4 * radius / height


def _curve(dice: _Dice) -> Made:
    lam, most = dice.of(0.05, 0.3), dice.of(0.3, 1)
    points = [[0.0, lam], [round(0.6 * most, 4), round(0.45 * lam, 4)], [most, 0.0]]
    return {
        "mechanism": "curve", "points": points, "control_height": 4.0, "centroid_height": 2.1, "mass": 12000.0,
        "inertia": 70000.0, "restitution": dice.of(0.7, 0.95),
    }, lam  # fmt: skip


def _point_mass(dice: _Dice) -> Made:
    width, height = dice.of(0.4, 2), dice.of(2, 8)
    return {"mechanism": "point_mass", "base_width": width, "height": height}, width / height / 2


def _wall(dice: _Dice) -> Made:
    thickness, height = dice.of(0.2, 0.6), dice.of(2.5, 4)
    return {"mechanism": "wall", "thickness": thickness, "height": height}, 4 * thickness / height


def _spanning_wall(dice: _Dice) -> Made:
    fields, lam = _wall(dice)
    more = {"overburden": dice.of(1e3, 2e4), "overburden_eccentricity": dice.of(0, 0.05)}
    return {**fields, "mechanism": "spanning_wall", "hinge": dice.choice(["weakest", 0.5, 0.6]), **more}, 1.5 * lam


def _symmetric_frame(dice: _Dice) -> Made:
    width, height = dice.of(0.5, 1.2), dice.of(3, 7)
    more = {"columns": dice.randint(2, 4), "spacing": dice.of(3, 6), "beam_depth": dice.of(0.5, 1.5)}
    fields = {"mechanism": "symmetric_frame", "column_width": width, "column_height": height, **more}
    return fields | {"mass_ratio": dice.of(0.3, 2)}, width / height


def _asymmetric_frame(dice: _Dice) -> Made:
    width, left = dice.of(0.5, 1.2), dice.of(3, 6)
    more = {"right_height": left + dice.of(0, 2), "spacing": dice.of(4, 8), "beam_depth": dice.of(0.5, 1.2)}
    return {"mechanism": "asymmetric_frame", "column_width": width, "left_height": left, **more}, 0.9 * width / left


def _arch(dice: _Dice) -> Made:
    radius, angle = dice.of(2, 8), dice.of(120, 170)
    more = {"thickness": round(radius * dice.of(0.14, 0.22), 3), "voussoirs": dice.randint(5, 11)}
    return {"mechanism": "arch", "radius": radius, "inclusion_angle_deg": angle, **more}, 0.4


def _linkage(dice: _Dice) -> Made:
    """Two columns under a beam."""
    width, height, span, deep = dice.of(0.4, 1), dice.of(2, 5), dice.of(1.5, 4), dice.of(0.3, 0.8)
    far = span + width
    bodies = {"left": _box(0, width, 0, height), "right": _box(span, far, 0, height)}
    joints = {
        "A": {"pivot": "left", "at": [width, 0.0]}, "B": {"hinge": ["left", "beam"], "at": [0.0, height]},
        "C": {"pivot": "right", "at": [round(far, 4), 0.0]}, "D": {"hinge": ["right", "beam"], "at": [span, height]},
    }  # fmt: skip
    bodies["beam"] = _box(0, far, height, height + deep)
    return {"mechanism": "linkage", "bodies": bodies, "positive": {"lead": "left", "joints": joints},
            "negative": "mirror"}, width / height  # fmt: skip


def _portal(dice: _Dice) -> Made:
    width, height, span, over = dice.of(0.5, 1), dice.of(1.5, 4), dice.of(1, 2.5), dice.of(0.05, 0.2)
    blocks = {"left": _box(0, width, 0, height), "right": _box(span + width, span + 2 * width, 0, height)}
    blocks["lintel"] = _box(-over, span + 2 * width + over, height, height + dice.of(0.3, 0.7))
    return _assembly(blocks, width / height)


def _gap(dice: _Dice) -> Made:
    """A block beside a wall, or between two."""
    width, height, lower = dice.of(0.3, 0.8), dice.of(1, 3), dice.of(0.5, 4)
    right = width + dice.of(0.005, 0.3)
    walls = {"right wall": _box(right, right + 0.5, 0, lower)}
    if dice.random() < 0.5:
        left = -dice.of(0.005, 0.3)
        walls["left wall"] = _box(left - 0.5, left, 0, lower)
    return _assembly({"block": _box(0, width, 0, height)}, width / height, **walls)


def _near(dice: _Dice) -> Made:
    """A wall near another that moves too."""
    width, height, other = dice.of(0.3, 0.8), dice.of(1, 3), dice.of(0.3, 1)
    start = width + dice.of(0.005, 0.5)
    blocks = {"wall": _box(0, width, 0, height), "other": _box(start, start + other, 0, dice.of(0.5, 3))}
    return _assembly(blocks, width / height)


def _plinth(dice: _Dice) -> Made:
    """A block on a plinth, wider or as wide."""
    width, height, low, wide = dice.of(0.3, 0.8), dice.of(1, 3), dice.of(0.2, 0.9), dice.of(0, 0.4)
    blocks = {"plinth": _box(-wide, width + wide, 0, low), "statue": _box(0, width, low, low + height)}
    return _assembly(blocks, width / (height + (0 if wide else low)))


def _shelf(dice: _Dice) -> Made:
    """An object on a shelf with a kerb at a distance."""
    width, height, start = dice.of(0.05, 0.4), dice.of(0.1, 1), dice.of(0.01, 0.5)
    kerb = _box(width + start, width + start + 0.05, 0, round(height * dice.of(0.05, 0.5), 4))
    return _assembly({"object": _box(0, width, 0, height)}, width / height, kerb=kerb)


KINDS = (
    _block, _rigid_body, _cone, _curve, _point_mass, _wall, _spanning_wall, _symmetric_frame, _asymmetric_frame, _arch,
    _linkage, _portal, _gap, _near, _plinth, _shelf,
)  # fmt: skip


def case(number: int) -> Case:
    """A case, the same everywhere."""
    dice, make = _Dice(number), KINDS[number % len(KINDS)]
    fields, lam = make(dice)
    if "density" not in fields and fields["mechanism"] not in ("curve", "symmetric_frame", "point_mass"):
        fields |= {"density": float(dice.randint(18, 26) * 100), "depth": dice.of(0.5, 1.5)}
    if fields["mechanism"] in ("symmetric_frame", "point_mass"):
        fields["mass"] = 12000.0
    if fields["mechanism"] != "curve":
        fields["friction"] = dice.of(0.05, 1.2)
    level, period = lam * dice.of(1, 6), dice.of(0.15, 2)
    if dice.random() < 0.6:
        shape = dice.choice(["sine", "cosine", "ricker", "half_sine"])
        return Case(make.__name__[1:], fields, {"motions": f"{shape}:{level:.3f}g:{period}s"})
    ask: dict[str, Any] = {"motions": str(dice.choice(_records())), "target_pga": round(level, 3)}
    if dice.random() < 0.3:
        ask["vertical"] = str(PROJECT / "examples" / "accel_transverse.csv")
    return Case(make.__name__[1:], fields, ask)


@cache
def _records() -> list[Path]:
    from tests.conftest import EXAMPLES, RECORDS

    return [EXAMPLES / "accel.csv", *sorted(RECORDS.glob("*2*8.AT2"))]


class Verdict(NamedTuple):
    """The lowest and the highest share of neighbours that overturn; refused in words if there is none."""

    lowest: float = 0.0
    highest: float = 1.0
    refused: str = ""

    @property
    def word(self) -> str:
        """What is said."""
        if self.refused:
            return "refused"
        if self.highest < SURE[0] or self.lowest > SURE[1]:
            return OPPOSITE[self.lowest > SURE[1]]
        return "unknown" if self.highest - self.lowest > LEEWAY else "chance"

    def against(self, other: Verdict) -> bool:
        """Whether this sure verdict is not that of another."""
        moved = max(abs(self.lowest - other.lowest), abs(self.highest - other.highest))
        return self.word in OPPOSITE and other.word != self.word and moved >= LEEWAY


def _made(given: Case) -> Any:
    import rocking_cli as rk

    fields = {key: value for key, value in given.fields.items() if key != "mechanism"}
    return rk.mechanisms[given.fields["mechanism"]](**fields)


def ask(number: int) -> tuple[Verdict, str]:
    """The verdict on a case by one degree of freedom, and the words of the answer."""
    import rocking_cli as rk

    given = case(number)
    try:
        answer = rk.respond(_made(given), model="nonlinear", neighbours=NEIGHBOURS, engine="exact", **given.ask)
    except rk.RockingError as error:
        return Verdict(refused=str(error)), ""
    share = answer.conclusion.share
    return Verdict(share.lowest, share.highest), "\n".join(map(str, answer.view.parts))


def by_blocks(number: int, scales: Sequence[float] = (1.0,)) -> tuple[Verdict, str]:
    """The verdict on a case by free blocks, at some scales of the motion."""
    import rocking_cli as rk

    given, found = case(number), list[bool]()
    try:
        for scale in scales:
            motion = {**given.ask, "target_pga": given.ask["target_pga"] * scale} if "target_pga" in given.ask else {
                **given.ask, "scale": scale}  # fmt: skip
            found.append(bool(rk.respond(_made(given), engine="blocks", **motion)["blocks"].fell))
    except rk.RockingError as error:
        return Verdict(refused=str(error)), ""
    return Verdict(min(found), max(found)), ""


ENGINES = {"exact": ask, "blocks": by_blocks, "around": partial(by_blocks, scales=AROUND)}
Found = dict[int, tuple[Verdict, str]]


def run(engine: str, numbers: Sequence[int], chosen: Sequence[str] = ()) -> Found:
    """The verdicts on cases by an engine in a process of its own, in which the chosen bounds are doubled."""
    given = json.dumps([engine, list(numbers), list(chosen)])
    ended = subprocess.run(
        [sys.executable, "-m", "tests.bounds", "-"], input=given, capture_output=True, text=True, check=False,
        cwd=PROJECT, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    rows = [json.loads(line) for line in ended.stdout.splitlines() if line.startswith("[")]
    found = {number: (Verdict(*verdict), text) for number, verdict, text in rows}
    return found | {
        number: (Verdict(refused=f"the process ended: {ended.stderr[-300:]}"), "")
        for number in numbers if number not in found
    }  # fmt: skip


def _child() -> None:
    engine, numbers, chosen = json.load(sys.stdin)
    double(chosen)
    for number in numbers:
        try:
            verdict, text = ENGINES[engine](number)
        except Exception as error:  # a bound that breaks the program is found too
            verdict, text = Verdict(refused=f"FAILED {error!r}"), ""
        print(json.dumps([number, verdict, text]), flush=True)


def in_parts(pool: ThreadPoolExecutor, engine: str, numbers: Sequence[int], chosen: Sequence[str] = ()) -> Found:
    """The same by several processes."""
    parts = pool.map(lambda k: run(engine, numbers[k::AT_ONCE], chosen), range(AT_ONCE))
    return {number: each for part in parts for number, each in part.items()}


class Change(NamedTuple):
    """A sure verdict that a doubled bound changes: the bounds that do so alone, and whether the answer names them."""

    number: int
    before: Verdict
    after: Verdict
    by: Sequence[str]
    named: bool


def changes(pool: ThreadPoolExecutor, found: Found, numbers: Sequence[int], kind: str) -> list[Change]:
    """What becomes of cases if all bounds of a kind are doubled at once, and which of them does it alone."""
    engine, lines, named = "blocks" if kind == "blocks" else "exact", listed()[kind], listed()["named"]
    after = in_parts(pool, engine, numbers, [*lines])
    moved = [number for number in numbers if found[number][0].against(after[number][0])]
    alone = dict(zip(lines, pool.map(lambda name: run(engine, moved, [name]), lines), strict=True)) if moved else {}
    result = []
    for number in moved:
        by = [name for name, each in alone.items() if found[number][0].against(each[number][0])]
        texts = found[number][1] + after[number][1] + after[number][0].refused
        told = bool(by) and all(name in named and named[name] in texts for name in by)
        result.append(Change(number, found[number][0], after[number][0], by, told))
    return result


def main() -> int:
    """Run all, print the table and what went wrong; how many verdicts changed unnamed, or were refuted."""
    numbers, free = range(int(os.environ.get("CASES", "2000"))), int(os.environ.get("FREE", "150"))
    few = max(len(numbers) // 20, 1)
    with ThreadPoolExecutor(AT_ONCE) as pool:
        found = in_parts(pool, "exact", numbers)
        sure = [number for number in numbers if found[number][0].word in OPPOSITE][:free]
        moved = {kind: changes(pool, found, numbers, kind) for kind in ("physical", "numerical")}
        moved["kernels"] = changes(pool, found, numbers[:few], "kernels")
        blocks = in_parts(pool, "blocks", sure)
        moved["blocks"] = changes(pool, blocks, sure[:few], "blocks")
        doubtful = [each for each in sure if found[each][0].against(blocks[each][0]) and not blocks[each][0].refused]
        around = in_parts(pool, "around", doubtful)
    refuted = [each for each in doubtful if around[each][0].word in OPPOSITE]
    print(f"Changed if doubled: kernels of {few} cases, free blocks of {len(sure[:few])}, all others of every case.")
    heads = "cases", *OPPOSITE, "chance", "unknown", "refused", *moved, "named", "asked", "refuted"
    print(f"{'kind':18}" + "".join(f"{each:>10}" for each in heads))
    of = [make.__name__[1:] for make in KINDS]
    for kind in [*of, "all"]:
        here = {number for number in numbers if kind in (of[number % len(of)], "all")}
        words = Counter(found[number][0].word for number in here)
        changed = [[one for one in each if one.number in here] for each in moved.values()]
        asked = sum(not blocks[each][0].refused for each in here & {*sure})
        told = sum(one.named for each in changed for one in each)
        cells = (
            len(here),
            *(words[each] for each in heads[1:6]),
            *map(len, changed),
            told,
            asked,
            len(here & {*refuted}),
        )
        print(f"{kind:18}" + "".join(f"{each:10}" for each in cells))
    for name, each in moved.items():
        for one in each:
            print(f"{name}: {'named' if one.named else 'CHANGED'} {one}\n  {json.dumps(case(one.number))}")
    for number in refuted:
        print(f"REFUTED {number}: {found[number][0]}, by blocks {around[number][0]}\n  {json.dumps(case(number))}")
    failed = [number for number in numbers if found[number][0].refused.startswith(BROKEN)]
    for number in failed:
        print(f"{number}: {found[number][0].refused}\n  {json.dumps(case(number))}")
    return len(refuted) + len(failed) + sum(not one.named for one in moved["physical"])


if __name__ == "__main__":
    sys.exit(_child() if sys.argv[1:] else 1 if main() else 0)
