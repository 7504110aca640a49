"""Write `drifting.csv`: examples/accel.csv as an instrument with an offset and a drift would have recorded it.

    python docs/make_drifting.py

Its accelerations are read 0.004 g too high, and 0.0005 g more every second.
"""

from __future__ import annotations

from pathlib import Path

import click

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "accel.csv"
OFFSET, DRIFT = 0.004, 0.0005  # in g, and g/s


@click.command()
@click.argument("out", type=click.Path(path_type=Path), default="drifting.csv")
def main(out: Path) -> None:
    """Write the record that drifts."""
    head, *rows = EXAMPLE.read_text(encoding="utf-8").splitlines()
    samples = (tuple(map(float, row.split(","))) for row in rows)
    drifting = [f"{t:.2f},{a + OFFSET + DRIFT * t:.6f}" for t, a in samples]
    out.write_text("\n".join([head, *drifting, ""]), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
