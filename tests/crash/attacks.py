"""Every command that writes, ended and made to fail at its calls on its folder: `make crash` at each, tests at some.

After each try the outputs are old or new, and whole; the exit code says what happened; and the same command, run again,
ends well and leaves nothing beside its outputs.
"""

from __future__ import annotations

import re
import shlex
import shutil
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, chdir, nullcontext
from io import StringIO
from itertools import groupby
from pathlib import Path
from unittest.mock import patch

from click.testing import CliRunner

from rocking_cli.cli.main import main
from tests.conftest import EXAMPLES
from tests.crash.calls import NEED_ROOM, Call, Ended, State, losses, run
from tests.meshes import box, obj

UNDER = f"--record {EXAMPLES}/accel.csv --neighbours 2"
BLOCK, SITE = f"{EXAMPLES}/block.yaml", f"{EXAMPLES}/verify/site.yaml"
STUDY = f"{EXAMPLES}/study/pedestal.yaml"
LINES = {
    "draw": f"draw {BLOCK} --plot p.svg --dxf d.dxf",
    "equiv": f"equiv {BLOCK} --out o.csv",
    "collapse": "collapse INPUTS/pillar.yaml --out o.yaml --plot p.png",
    "error": f"error {BLOCK} --plot p.pdf",
    "record": f"record {EXAMPLES}/accel.csv --out o.csv --spectrum s.csv --plot p.png",
    "records": f"record {EXAMPLES}/accel.csv {EXAMPLES}/accel_transverse.csv --out folder",
    "select": f"select {EXAMPLES}/accel.csv {EXAMPLES}/accel_transverse.csv --target {EXAMPLES}/target.csv "
    "--band 0.2:2 --count 2 --out folder --plot p.png",
    "respond": f"respond {BLOCK} {UNDER} --out o.csv --plot p.svg",
    "engines": "respond INPUTS/short.yaml --pulse sine:0.3g:0.2s --engine blocks --out o.csv --plot p.png "
    "--animate a.html",
    "margin": f"margin {BLOCK} {UNDER} --out o.csv --plot p.png",
    "demand": f"demand {SITE} --out o.csv --plot p.png",
    "verify": f"verify {BLOCK} --site {SITE} --plot p.png --sheet s.html",
    "building": f"building INPUTS/house.yaml --site {SITE} --out o.csv --plot p.png --sheet s.html --structures folder",
    "survey": f"survey INPUTS/table.csv {UNDER} --out o.csv --page p.html --map m.png --plot p.png",
    "collection": f"survey INPUTS/list.csv --record {EXAMPLES}/accel.csv --neighbours 60 --labels l.pdf",
    "sheets": f"survey INPUTS/table.csv --site {SITE} --sheets folder",
    "design": f"design {BLOCK} --vary width=0.5:0.9 --until lambda>=0.2 --points 3 --out o.csv --plot p.png",
    "calibrate": f"calibrate {EXAMPLES}/calibrate/block.yaml --free INPUTS/trace.csv --out o.yaml --plot p.png",
    "animate": f"animate {BLOCK} --pulse sine:0.5g:0.3s --neighbours 0 --speed 9 --out a.gif",
    "overturning": f"overturning {BLOCK} --points 3 --out o.csv --plot p.png",
    "spectrum": f"spectrum {BLOCK} --record {EXAMPLES}/accel.csv --sizes 1:6 --count 3 --out o.csv --plot p.png",
    "equivalent_pulses": f"equivalent_pulses {BLOCK} {EXAMPLES}/frame.yaml --ag 0.5g --period 0.6 --out o.csv "
    "--plot p.png",
    "fragility": f"fragility {STUDY} --store s.runs --jobs 1 --plot folder --nrml n.xml",
    "restart": f"fragility {STUDY} --store s.runs --jobs 1 --restart",
    "free_blocks": "fragility INPUTS/free.yaml --store s.runs --jobs 1",
    "results": "results INPUTS/study.runs --out o.csv --curves c.csv --nrml n.xml --plot folder --pelicun parts",
    "report": f"report {BLOCK} {UNDER} -o r.html",
    "explore": f"explore {BLOCK} {UNDER} --out e.html",
    "mechanisms": "mechanisms --plot p.png",
    "new": "new odd --plugin -o folder",
    "import": f"import {EXAMPLES}/drawings/wall.svg --scale 1:50 --depth 1 --density 2000 --out o.yaml --plot p.png",
    "mesh": "import INPUTS/box.obj --units m --density 2000 --out o.yaml --page p.html",
}
"""What each command that writes is asked, with every option that names an output."""
BEFORE = {
    "restart": f"fragility {STUDY} --store s.runs --jobs 1",
    "select": f"select {EXAMPLES}/accel.csv {EXAMPLES}/accel_transverse.csv --target {EXAMPLES}/target.csv "
    "--band 0.2:1 --count 1 --out folder",
    "sheets": f"survey INPUTS/table.csv --site {SITE} --sheets folder --language it",
}
"""What has written into the same folder before; the first file of the others was there before, by any program."""
INPUTS = {
    "pillar.yaml": "mechanism: assembly\ndensity: 2000\ndepth: 1\nblocks:\n"
    "  low: {polygon: [[0, 0], [0.6, 0], [0.6, 1], [0, 1]]}\n  top: {polygon: [[0, 1], [0.6, 1], [0.6, 3], [0, 3]]}\n"
    "ground:\n  base: {polygon: [[-1, -1], [2, -1], [2, 0], [-1, 0]]}\n",
    "trace.csv": "".join((EXAMPLES / "calibrate" / "trace.csv").read_text("utf-8").splitlines(keepends=True)[:250]),
    "house.yaml": "levels: [0, 3]\nmasonry: {density: 1800}\nwalls: [{name: wall, length: 5, thickness: 0.5}]\n",
    "short.yaml": "mechanism: block\nwidth: 1\nheight: 2\nname: short\n",
    "table.csv": "mechanism,name,width,height,longitude,latitude\nblock,low,0.5,1.5,10,45\nblock,high,0.4,2,10.1,45\n",
    "list.csv": "No.,Object,Height (cm),Width (cm)\n1,stele,200,40\n",
    "free.yaml": "structures: [short.yaml]\nrecords: [{pulse: sine:0.9g:0.3s}]\nmethod: stripes\nengine: blocks\n"
    "levels: {measure: PGA, least: 0.3, most: 0.6, count: 2}\nlimit_states: [overturning]\npolarity: 1\n",
}
LEFT = re.compile(r"\..+\.[0-9a-f]{16}(\.[\w-]+)?")
"""What a killed command may leave until the next one: a file, or a folder, that is not whole."""
DRAWN = {"draw", "animate", "collection"}
"""Commands whose pictures are drawn; those of the others are so many bytes, as they take most of their time."""
MEMORY = [int(2**k * 1e5) for k in range(11, -1, -1)]  # bytes

LIGHT = {
    "rocking_cli.ask.answer._draw": lambda *_, **__: None,
    "rocking_cli.plotting.style.save": lambda figure, stream, **_: stream.write(
        "<svg/>" if isinstance(stream, StringIO) else bytes(20_000)
    ),
    "rocking_cli.documents.sheet_page.inline_svg": lambda draw, prefix: f"[{prefix}]",
    "rocking_cli.questions.report.study.MAP_POINTS": 3,
}
"""What stands for pictures; few points of a map."""

Key = frozenset[tuple[Path, bytes | None]]


def state(folder: Path) -> State:
    """What is in a folder; not the settings and caches of its user."""
    return {
        path.relative_to(folder): None if path.is_dir() else path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.relative_to(folder).parts[0] != "home"
    }


def restore(folder: Path, before: State) -> None:
    """Make a folder that holds this and no more."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for path, content in sorted(before.items(), key=lambda each: each[0]):
        if content is None:
            (folder / path).mkdir(exist_ok=True)
        else:
            (folder / path).write_bytes(content)


def light() -> ExitStack:
    """Let commands draw no pictures within this context."""
    stack = ExitStack()
    for what, instead in LIGHT.items():
        stack.enter_context(patch(what, instead))
    return stack


def words_of(name: str, inputs: Path) -> list[str]:
    """Return what is typed for a command, whose inputs are made in a folder."""
    inputs.mkdir(parents=True)
    for file, text in INPUTS.items():
        (inputs / file).write_text(text, encoding="utf-8")
    (inputs / "box.obj").write_bytes(obj(box((0.0, 0.0, 0.0), (0.6, 0.8, 2.4))))
    if name == "results":
        study = shlex.split(f"fragility {STUDY} --store {inputs}/study.runs --jobs 1")
        assert CliRunner().invoke(main, study).exit_code == 0
    return shlex.split(LINES[name].replace("INPUTS", str(inputs)))


def attack(name: str, place: Path, one_in: int = 1) -> tuple[Counter[str], list[str]]:
    """Try a command at all calls, or one in so many; return the numbers of calls, tries and faults, and the faults."""
    with nullcontext() if name in DRAWN else light():
        attacked = Attacked(name, place)
        attacked.all(one_in)
    figures = Counter(calls=len(attacked.traced.calls), faults=len(attacked.faults))
    return attacked.tries + figures, attacked.faults


class Attacked:
    """One command, what was there before it and what it writes, and the tries so far with what went wrong."""

    def __init__(self, name: str, place: Path) -> None:
        self.folder = place / "folder"
        self.before: State = {}
        self.words = words_of(name, place / "inputs")
        if name in BEFORE:
            self.before = self._warm(BEFORE[name].replace("INPUTS", str(place / "inputs")))
        self._warm(shlex.join(self.words))
        if not self.before:
            first = next((path for path, text in state(self.folder).items() if text is not None), Path("no/file"))
            self.before = {first: b"old\n"} if first.parent == Path() else {}
        self.tries: Counter[str] = Counter()
        self.faults: list[str] = []
        self._again: dict[Key, str] = {}
        self.whole = self._run()  # it also makes what is there from the first run on, such as compiled code
        self.after = state(self.folder)
        self.traced = self._run(traced=True)
        assert self.whole.code == self.traced.code == 0, self.whole.said
        again = state(self.folder)
        self.unlike = {path for path, text in self.after.items() if again.get(path) != text}
        self.faults += [f"{path} differs from run to run" for path in sorted(self.unlike)]
        assert self.traced.calls, "strace has seen no call"

    def _warm(self, line: str) -> State:
        restore(self.folder, self.before)
        with chdir(self.folder):
            done = CliRunner().invoke(main, shlex.split(line), env={"SOURCE_DATE_EPOCH": "0"})
        assert done.exit_code == 0, f"{line}: {done.output}{done.exception!r}"
        return state(self.folder)

    def _run(self, *injected: str, traced: bool = False, memory: int | None = None) -> Ended:
        restore(self.folder, self.before)
        return run(self.words, self.folder, *injected, traced=traced, memory=memory)

    def all(self, one_in: int = 1) -> None:
        """Try all, or one in so many."""
        calls = [*_unlike(self.traced.calls)]
        changing = [call for call in calls if call.changes]
        for call in changing[::one_in]:
            self.kill(call)
        for call in changing[one_in // 3 :: one_in]:
            self.stop(call)
        for call in changing[one_in // 2 :: one_in]:
            self.error(call, "EIO")
            if call.name in NEED_ROOM:
                self.error(call, "ENOSPC")
        looks = {(call.name, call.paths): call for call in calls if not call.changes}
        for call in [*looks.values()][::one_in]:
            self.error(call, "EIO")
        for size in MEMORY[::one_in]:
            self.memory(size)
        self.losses(one_in)

    def kill(self, call: Call) -> None:
        """End the command at a call."""
        ended = self._run("-e", f"inject={call.name}:signal=KILL:when={call.nth}")
        self._judge("SIGKILL", f"killed at {call.name}", ended, codes=(-9,), left=True)

    def stop(self, call: Call) -> None:
        """Ask the command to end as it makes a call; it takes away what is not whole."""
        ended = self._run("-e", f"inject={call.name}:signal=TERM:when={call.nth}")
        self._judge("SIGTERM", f"SIGTERM at {call.name}", ended, codes=(0, 143))

    def error(self, call: Call, error: str) -> None:
        """Let a call fail."""
        ended = self._run("-e", f"inject={call.name}:error={error}:when={call.nth}")
        if not any(each.injected for each in ended.calls):
            self.tries["missed"] += 1  # another call, not on the folder, was the nth this time
            return
        codes = (0, 1) if call.changes else (0, 1, 2)
        self._judge(error, f"{error} at {call.name}", ended, codes, left="unlink" in call.name)

    def memory(self, size: int) -> None:
        """Let the command have so much memory more."""
        self._judge("memory", f"{size / 1e6:.1f} MB", self._run(memory=size), codes=(0, 1))

    def losses(self, one_in: int) -> None:
        """Let the power fail after each call."""
        restore(self.folder, self.before)
        traced = self._run(traced=True)
        self.after = state(self.folder)
        lost, sure = losses(traced.calls, self.folder, self.before)
        for call, each in [*zip([call for call in traced.calls if call.changes], lost, strict=False)][::one_in]:
            self.tries["power"] += 1
            self._look(f"power loss after {call.name}", each, left=True)
        self.tries["power"] += 1
        self._look("power loss after the end", sure, left=True, done=True)

    def _judge(self, kind: str, what: str, ended: Ended, codes: Sequence[int], left: bool = False) -> None:
        self.tries[kind] += 1
        if ended.code not in codes:
            self._fault(what, f"exit code {ended.code}: {ended.said.strip()[-300:]}")
        elif "Traceback" in ended.said or (ended.code > 0 and "error" not in ended.said.lower()):
            self._fault(what, f"said {ended.said[-300:]!r}")
        self._look(what, state(self.folder), left=left, done=ended.code == 0)

    def _look(self, what: str, found: State, *, left: bool = False, done: bool = False) -> None:
        """See whether outputs are old or new, and whole, and whether the command can be run again."""
        for fault in self._half(found, left=left, done=done):
            self._fault(what, fault)
        if found == self.after:  # there is nothing to go on with
            return
        key = frozenset((_plain(path), text) for path, text in found.items())
        if key not in self._again:
            restore(self.folder, found)
            again = run(self.words, self.folder)
            wrong = [*self._half(state(self.folder), done=True)]
            self._again[key] = (
                f"exit code {again.code}: {again.said.strip()[-300:]}" if again.code else ", ".join(wrong)
            )
        if self._again[key]:
            self._fault(what, f"run again: {self._again[key]}")

    def _half(self, found: State, *, left: bool = False, done: bool = False) -> Iterator[str]:
        for path, text in found.items():
            if path.parts[0].startswith(("home", "s.before-")):  # caches; a store that is put aside half-way
                continue
            if any(LEFT.fullmatch(part) for part in path.parts):
                if not left and (done or len(path.parts) == 1):  # in a folder the next run takes them away
                    yield f"{_plain(path)} is left"
            elif not (states := [each for each in (self.after, *[self.before] * (not done)) if path in each]):
                yield f"{path} is left"
            elif text not in [each[path] for each in states] and (path not in self.unlike or not text):
                yield f"{path} is neither old nor new: {len(text or b'')} of {len(self.after.get(path) or b'')} bytes"
        for path in self.after if done else self.before:
            aside = Path("s.before.runs", *path.parts[1:])
            if path not in found and (done or (path in self.after and aside not in found)):
                yield f"{path} is gone"

    def _fault(self, what: str, fault: str) -> None:
        self.faults.append(f"{what}: {fault}")


def _unlike(calls: Sequence[Call]) -> Iterator[Call]:
    """Return calls; of many of a kind on a file in a row the first, the middle and the last."""
    for _, group in groupby(calls, lambda call: (call.name, call.paths)):
        same = [*group]
        for k in sorted({0, len(same) // 2, len(same) - 1}):
            yield same[k]


def _plain(path: Path) -> Path:
    """Return a path without what chance has put in."""
    return Path(*(re.sub(r"\.[0-9a-f]{16}(?=\.|$)", ".HEX", part) for part in path.parts))
