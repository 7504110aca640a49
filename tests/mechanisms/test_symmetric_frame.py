"""The joints of a symmetric frame: those of a linkage of the same frame, if spacing and depth of its beam are given."""

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.core.registry import Registry
from rocking_cli.core.released import released, tabulated_impulses
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.modes import modes
from rocking_cli.structure import build_models
from tests.cli.test_cli import run_json

WIDTH, HEIGHT, SPACING, DEPTH = 0.8, 5.0, 3.0, 0.9
COMMON = {"density": 2500.0, "depth": 0.8}


def frame(columns=2, depth=DEPTH, **more):
    """A frame whose beam is of the density of its columns."""
    ratio = ((columns - 1) * SPACING + WIDTH) * depth / (columns * WIDTH * HEIGHT)
    sizes = {"column_width": WIDTH, "column_height": HEIGHT, "spacing": SPACING, "beam_depth": depth}
    fields = {**sizes, "columns": columns, "mass_ratio": ratio, **COMMON}
    return Registry()["symmetric_frame"].from_fields({**fields, **more})


def linkage(columns=2, depth=DEPTH, **more):
    def box(x, y, width, height):
        return {"polygon": [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]}

    names, b = [f"column {k + 1}" for k in range(columns)], WIDTH / 2
    bodies = {name: box(k * SPACING - b, 0.0, WIDTH, HEIGHT) for k, name in enumerate(names)}
    bodies["beam"] = box(-b, HEIGHT, (columns - 1) * SPACING + WIDTH, depth)
    joints = {}
    for k, name in enumerate(names):
        joints[f"A{k}"] = {"pivot": name, "at": [k * SPACING + b, 0.0]}
        joints[f"B{k}"] = {"hinge": [name, "beam"], "at": [k * SPACING - b, HEIGHT]}
    fields = {"bodies": bodies, "positive": {"lead": names[0], "joints": joints}, **COMMON}
    return Registry()["linkage"].from_fields({**fields, **more})


def by_label(found):
    """Forces and compliances of each contact, by its name."""
    return {
        contact.label: (found.force[:, [*normal, shear]], found.compliance[:, [*normal, shear]])
        for contact, (normal, shear) in zip(found.contacts, found.rows, strict=True)
        if shear is not None
    }


def same_tables(one, other, near):
    one, other = by_label(one), by_label(other)
    assert one.keys() == other.keys()
    most = max(np.abs(force).max() for force, _ in other.values())
    for label, (force, compliance) in one.items():
        np.testing.assert_allclose(force, other[label][0], rtol=0, atol=near * most, err_msg=label)
        np.testing.assert_allclose(compliance, other[label][1], rtol=near, err_msg=label)


AT = {"body": "beam", "at": [0.7, 5.6]}


def hung(*bodies, **more):
    """A load on the beam, and on each of some bodies a mass, a force, and a tie to the beam that is stressed."""
    loads, ties = [{"name": "roof", "mass": 4e3, **AT}], []
    for k, body in enumerate(bodies):
        x = k * SPACING
        loads += [
            {"name": f"mass {k}", "mass": 800.0, "horizontal": 0.5, "body": body, "at": [x + 0.1, 4.0], **more},
            {"name": f"force {k}", "force": [500.0, -900.0], "body": body, "at": [x - 0.2, 3.0], **more},
        ]
        ends = {"from": {"body": body, "at": [x + 0.2, 4.5]}, "to": {"body": "beam", "at": [x + 0.3, 5.5]}}
        ties.append({"name": f"tie {k}", **ends, "stiffness": 2e5, "prestress": 3e3, **more})
    return {"loads": loads, "ties": ties}


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [
        ({}, {}),
        ({"friction": 0.6}, {"friction": 0.6}),
        (hung("columns"), hung("column 1")),
        (hung("columns", each=True), hung("column 1", "column 2")),
    ],
    ids=["bare", "friction", "on one column", "on each column"],
)
def test_two_columns_have_the_forces_of_a_linkage(ours, theirs):
    one, other = frame(**ours), linkage(**theirs)
    for direction in Direction:
        phi = np.linspace(0.0, 0.9 * other.critical_rotation(direction), 5)
        same_tables(released(one, direction, phi), released(other, direction, phi), 1e-9)
        # Sorted, as the linkage mirrors the order of its joints.
        struck, expected = (
            np.sort(tabulated_impulses(each, direction) @ [1.0, each.eta(direction)]) for each in (one, other)
        )
        np.testing.assert_allclose(struck, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_columns_have_the_histories_of_a_linkage(monkeypatch):
    """Of squat columns: known, and unknown under some; with a deep beam that turns, under more of them."""
    for name, size in (("WIDTH", 1.0), ("HEIGHT", 3.0), ("SPACING", 2.0)):
        monkeypatch.setitem(globals(), name, size)
    unknown = []
    for depth, pulses in (
        (1.0, ("sine:0.4g:1s", "sine:0.5g:0.8s", "sine:1.5g:1s")),
        (3.0, ("sine:0.4g:1s", "sine:0.3g:2s")),
    ):
        one, other = (make(2, depth, friction=0.6) for make in (frame, linkage))
        models = [build_models(each, ("nonlinear",))[0] for each in (one, other)]
        for pulse in pulses:
            motion = rk.parse_pulse(pulse).sampled()
            ours, theirs = (follow(model, motion) for model in models)
            unknown.append(ours.unknown)
            assert (ours.unknown, ours.overturned) == (theirs.unknown, theirs.overturned)
            for key in ("peak_ratio", "opening", "known_to", "lower_bound"):
                assert getattr(ours, key) == pytest.approx(getattr(theirs, key), rel=1e-9, nan_ok=True), (pulse, key)
    assert unknown == [False, True, False, True, False]


def test_three_columns_have_the_modes_of_a_linkage():
    one, other = frame(3, friction=0.6), linkage(3, friction=0.6)
    critical = one.critical_rotation(Direction.POSITIVE)
    phi = np.linspace(0.0, critical, 5)
    ours, theirs = (modes(each, Direction.POSITIVE, phi, critical) for each in (one, other))
    same_tables(ours.released, theirs.released, 1e-6)
    np.testing.assert_allclose(ours.struck, theirs.struck, rtol=1e-6, atol=1e-6 * np.abs(theirs.struck).max())


BARE = {"column_width": 1.0, "column_height": 3.0, "mass_ratio": 1.5, "density": 2400.0, "depth": 1.0}
TO_SCALE = {"spacing": 3.0, "beam_depth": 0.6}


def written(tmp_path, **fields):
    lines = [f"{key}: {value}" for key, value in {"mechanism": "symmetric_frame", **BARE, **fields}.items()]
    (tmp_path / "frame.yaml").write_text("\n".join(lines))
    return tmp_path / "frame.yaml"


def test_without_its_spacing_a_frame_is_not_checked_and_says_what_is_missing(tmp_path):
    shaken = ("--pulse", "sine:0.5g:0.8s", "--neighbours", 0)
    file = written(tmp_path, friction=0.8)
    found = run_json("respond", file, *shaken)
    caution = "Caution: the joints of this mechanism are not checked: give spacing and beam_depth."
    assert found["notes"] == [caution]
    history = found["responses"]["nonlinear"]
    assert (history["unknown"], history["opening"], history["outcome"]) == (None, None, "at_rest")
    given = run_json("respond", written(tmp_path, friction=0.8, **TO_SCALE), *shaken)
    assert given["notes"] == [] and given["responses"]["nonlinear"]["unknown"] is not None
    single = rk.SymmetricFrame(**BARE, columns=1)
    assert single.contacts(Direction.POSITIVE) is None and "single column" in single.unchecked


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"spacing": 3.0}, "beam_depth is missing"),
        ({"beam_depth": 0.6}, "spacing is missing"),
        ({"spacing": 0.9, "beam_depth": 0.6}, "the columns overlap"),
        ({**TO_SCALE, "columns": 1}, "spacing has no effect, as the file does not say what keeps the beam"),
        ({**TO_SCALE, "columns": 21}, "spacing has no effect, as it has more than 20 columns"),
    ],
)
def test_sizes_that_do_not_fit(fields, said):
    with pytest.raises(rk.InputError, match=said):
        rk.SymmetricFrame(**BARE, **fields)


def test_with_its_spacing_it_is_drawn_to_scale():
    sketch = rk.SymmetricFrame(**BARE, **TO_SCALE, columns=3).sketch()
    (beam,) = sketch.outlines["beam"]
    assert sketch.copies["columns"] == [0, 3, 6] and not sketch.notes and not sketch.at_will
    assert beam == pytest.approx((-0.5 + 3j, 6.5 + 3j, 6.5 + 3.6j, -0.5 + 3.6j))
    assert rk.SymmetricFrame(**BARE, **TO_SCALE).enlarged(2.0).spacing == 6.0
