"""The motion of each block as a table, beside rotations about corners by hand."""

import csv

import numpy as np

import rocking_cli as rk
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES


def test_a_block_turns_about_its_corners():
    block, motion = rk.Block(width=0.7, height=2.8), "sine:0.4g:0.6s"
    frame = rk.respond(block, motion, model="nonlinear", each_block=True).columns()
    phi = rk.respond(block, motion, model="nonlinear").runs[1]["nonlinear"].phi
    assert phi.min() < -0.01 or phi.max() > 0.01
    corner = np.where(phi >= 0, 0.35, -0.35)  # of the foot, about its middle; clockwise about the right one
    arm_x, arm_z = -corner, 1.4
    x = corner + arm_x * np.cos(phi) + arm_z * np.sin(phi)
    z = arm_z * np.cos(phi) - arm_x * np.sin(phi)
    moved = np.asarray(frame["x [m]"]) - np.asarray(frame["x [m]"])[0]
    assert np.allclose(moved, x - x[0], atol=1e-12) and np.allclose(frame["z [m]"], z, atol=1e-12)
    assert np.allclose(frame["rotation [rad]"], phi, atol=1e-15)


def test_hinged_blocks_stay_together(tmp_path, monkeypatch):
    """Points that blocks share at a hinge are one point in the table at all times, and those on the ground stay."""
    monkeypatch.chdir(tmp_path)
    file, motion = EXAMPLES / "assembly.yaml", ("--pulse", "sine:0.4g:0.8s", "--polarity", "both")
    assert run("respond", str(file), *motion, "--each-block", "--out", "o.csv").exit_code == 0
    table = csv.DictReader((tmp_path / "o.csv").read_text("utf-8").splitlines())
    rows = [row for row in table if row["polarity"] == "1" and row["x [m]"]]
    assert list(rows[0]) == ["polarity", "t [s]", "block", "x [m]", "z [m]", "rotation [rad]"]
    at = {}
    for row in rows:
        at.setdefault(row["block"], []).append([float(row[key]) for key in ("x [m]", "z [m]", "rotation [rad]")])
    mechanism = rk.load_structure(file)
    assert at.keys() == {body.name for body in mechanism.bodies()}

    def carried(name, point):
        x, z, turn = np.array(at[name]).T
        return x + 1j * z + (point - (x[0] + 1j * z[0])) * np.exp(-1j * turn)

    phi = np.array(at[mechanism.collapse(rk.Direction.POSITIVE).lead])[:, 2]
    for direction in rk.Direction:
        during = phi * direction > 0
        hinges = mechanism.joints(direction)
        assert during.any() and {len(each.bodies) for each in hinges} == {1, 2}  # with phi they give all places
        for hinge in hinges:
            one, *others = (carried(name, hinge.point)[during] for name in hinge.bodies)
            assert np.abs(one - (others[0] if others else hinge.point)).max() < 1e-7


def test_the_table_needs_a_file():
    refused = run("respond", "--pulse", "sine:0.4g:0.6s", "--each-block", code=2)
    assert "--each-block has no effect without --out" in refused.stderr
