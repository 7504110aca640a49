"""A full or broken disk ends every command that writes with 1: none counts what it could not write as skipped."""

import errno
import shlex

import click
import pytest
from click.testing import CliRunner

from rocking_cli.cli.help import OUTPUT_HEADING
from rocking_cli.cli.main import main
from rocking_cli.io import files
from rocking_cli.plugins.rooms import commands
from tests.cli.test_every_command import needs_mujoco
from tests.conftest import EXAMPLES
from tests.meshes import box, obj
from tests.stores import write

BLOCK, ACCEL, ACROSS = EXAMPLES / "block.yaml", EXAMPLES / "accel.csv", EXAMPLES / "accel_transverse.csv"
SITE, PULSE = EXAMPLES / "verify" / "site.yaml", "--pulse sine:0.5g:0.5s"
LINES = {
    "draw": f"{BLOCK}",
    "equiv": f"{BLOCK}",
    "collapse": f"{EXAMPLES / 'assembly.yaml'}",
    "import": "outline.csv --units mm --depth 1 --density 2000",
    "error": f"{BLOCK}",
    "record": f"{ACCEL}",
    "select": f"{ACCEL} {ACROSS} --target {EXAMPLES / 'target.csv'} --band 0.2:2 --count 1",
    "respond": f"{BLOCK} {PULSE} --neighbours 0",
    "margin": f"{BLOCK} {PULSE} --neighbours 2",
    "crosscheck": f"{BLOCK} {PULSE}",
    "verify": f"{BLOCK} --site {SITE}",
    "demand": f"{SITE}",
    "survey": "survey.csv",
    "design": f"{BLOCK} --vary width=0.5:0.9 --until 'lambda>=0.2'",
    "calibrate": f"{EXAMPLES / 'calibrate' / 'block.yaml'} --free {EXAMPLES / 'calibrate' / 'trace.csv'}",
    "animate": f"{BLOCK} {PULSE}",
    "overturning": f"{BLOCK} --points 3",
    "spectrum": f"{BLOCK} --record {ACCEL} --slenderness 0.2",
    "equivalent_pulses": f"{BLOCK} {BLOCK} --ag 0.5g --period 0.6",
    "fragility": "study.yaml",
    "results": "study.runs",
    "report": f"{BLOCK}",
    "mechanisms": "",
    "new": "odd --plugin",
    ("survey", "--sheets"): f"survey.csv --site {SITE}",
    ("import", "--page"): "box.obj --units m --density 2000",
}
NO_FILE_OF_OURS = ("--record",)  # what is read
FOLDERS = {"FOLDER": "folder", "PLACE": "folder"}


def outputs():
    """Each option of a command that names an output, and a name for it."""
    for command in commands():
        for option in main.get_command(click.Context(main), command).params:
            named = str(option.metavar)
            if max(option.opts, key=len) not in NO_FILE_OF_OURS and (
                "output_path" in getattr(option.callback, "__qualname__", "")
                or named in FOLDERS
                or (getattr(option, "heading", "") == OUTPUT_HEADING and named.startswith("FILE"))
            ):
                yield command, max(option.opts, key=len), FOLDERS.get(named, named.replace(".png", ".svg"))


@pytest.fixture
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    corners = ("0,0", "600,0", "600,2400", "0,2400")
    (tmp_path / "outline.csv").write_text("\n".join(["x,y", *corners]), encoding="utf-8")
    row = "block,a,0.5,3,44,11"
    (tmp_path / "survey.csv").write_text(f"mechanism,name,width,height,latitude,longitude\n{row}\n", encoding="utf-8")
    (tmp_path / "tests.csv").write_text(f"structure,record,overturned\n{BLOCK},{ACCEL},0\n", encoding="utf-8")
    (tmp_path / "box.obj").write_bytes(obj(box((0, 0, 0), (1, 1, 3))))
    study = write(tmp_path, name="study", levels=5)
    study.write_text(
        study.read_text("utf-8").replace("records:", "records:\n  - pulse: sine:0.8g:1s"), encoding="utf-8"
    )


@pytest.mark.every(12)
@pytest.mark.parametrize(("command", "option", "name"), [*outputs()])
@pytest.mark.usefixtures("_here")
def test_the_exit_code_is_that_of_the_system(command, option, name, tmp_path, monkeypatch):
    needs_mujoco(command)
    if command == "results":
        assert CliRunner().invoke(main, ["fragility", "study.yaml"]).exit_code == 0
    before = set(tmp_path.rglob("*"))
    code = (errno.ENOSPC, errno.EIO, errno.EDQUOT)[len(command + option) % 3]

    def full(file, data):
        file.refused = OSError(code, "no room")
        raise file.refused

    monkeypatch.setattr(files._Output, "write", full)
    line = f"{command} {LINES.get((command, option), LINES[command])} {option} {name}"
    done = CliRunner().invoke(main, shlex.split(line))
    assert done.exit_code == 1 and "cannot be written: no room" in done.stderr, (line, done.output, done.exception)
    assert not [each for each in {*tmp_path.rglob("*")} - before if each.is_file() and each.suffix != files.LISTING]
