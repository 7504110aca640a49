"""Write a table of shake-table tests of two granite boulders, with their structures and records, to be scored.

    python -m validation.granite EXPERIMENTS FOLDER

EXPERIMENTS holds `granite_boulders.csv` and `granite_motions_100hz.npz`, the data of Chen and others
(virtual_shake_robot), which are not part of this project. FOLDER receives `tests.csv`, 600 rows, and what it names: one
structure file for each boulder and one record for each motion. Each boulder is a rigid body on the first edge of its
foot, with the restitution of its kinematics.
"""

from __future__ import annotations

import csv
import sys
from math import radians, tan
from pathlib import Path

import numpy as np

SPECIMENS = {"sp1": (0.2943, 0.0510, 4.97), "sp2": (0.2920, 0.0507, 5.47)}
"""Height of the centroid [m], squared radius of gyration [m2] and angle of the first edge [deg]."""
DT = 0.01  # s


def structure(name: str, height: float, gyration: float, angle: float) -> str:
    """Return the structure file of a boulder: a body on an edge, by the place of its centroid."""
    half = height * tan(radians(angle))
    return f"""# A granite boulder on the first edge of its foot; only its centroid, inertia and edge matter.
mechanism: linkage
name: {name}
bodies:
  rock:
    polygon: [[{-half:.9g}, 0], [{half:.9g}, 0], [{half:.9g}, {2 * height:.9g}], [{-half:.9g}, {2 * height:.9g}]]
    mass: 100
    centroid: [0, {height:.9g}]
    inertia: {100 * gyration:.9g}
positive: {{lead: rock, joints: {{O: {{pivot: rock, at: [{half:.9g}, 0]}}}}}}
"""


def write(source: Path, folder: Path) -> int:
    """Write the table and what it names into a folder, and return the number of tests."""
    (folder / "records").mkdir(parents=True, exist_ok=True)
    for name, shape in SPECIMENS.items():
        (folder / f"{name}.yaml").write_text(structure(f"boulder {name}", *shape), encoding="utf-8", newline="\n")
    with np.load(source / "granite_motions_100hz.npz") as archive:
        shaken = dict(archive)
    places = {int(number): k for k, number in enumerate(shaken["test"])}
    rows = []
    with (source / "granite_boulders.csv").open(encoding="utf-8") as stream:
        for test in csv.DictReader(stream):
            k = places[int(test["test"])]
            part = shaken["samples"][shaken["start"][k] : shaken["start"][k] + shaken["length"][k]]
            lines = (f"{DT * i:.2f},{a!r}" for i, a in enumerate((part / 32767 * float(shaken["peak"][k])).tolist()))
            record = f"records/{test['test']}.csv"
            text = "time [s],acceleration [m/s2]\n" + "\n".join(lines) + "\n"
            (folder / record).write_text(text, encoding="utf-8", newline="\n")
            rows += [
                [f"{name}.yaml", record, test[name], test["motion"], "recorded", test["pgv_disp_ms"]]
                for name in SPECIMENS
            ]
    with (folder / "tests.csv").open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["structure", "record", "overturned", "cluster", "motion", "pgv [m/s]"])
        table.writerows(rows)
    return len(rows)


def main() -> int:
    """Write the table."""
    if len(sys.argv) != 3:
        print(__doc__)
        return 2
    print(f"{write(Path(sys.argv[1]), Path(sys.argv[2]))} tests in {Path(sys.argv[2]) / 'tests.csv'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
