"""What an import of a drawing or a mesh costs, against half as much, and against `ezdxf.readfile` of the same file.

    python benchmarks/importing.py

Processor time of the verb, files included, with the search for garbage as rare as in the command `rocking`; the growth
is the time over that of half the size. Memory is what the largest size adds to the process above a hundredth of it, the
import before `ezdxf.readfile`, each in a process of its own.
"""

from __future__ import annotations

import gc
import multiprocessing
import struct
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import rocking_cli as rk
from rocking_cli.__main__ import GARBAGE_THRESHOLD

SIDE, GAP = 1000.0, 2.0  # of a stone and between stones [mm]
COLUMNS = 70
LEAST_MEMORY = 10.0  # that a ratio compares [MB]


def corners(count: int) -> list[list[tuple[float, float]]]:
    """Return the corners of stones in rows [mm]."""
    stones = []
    for k in range(count):
        x, y = (k % COLUMNS) * (SIDE + GAP), (k // COLUMNS) * (SIDE + GAP)
        stones.append([(x, y), (x + SIDE, y), (x + SIDE, y + SIDE), (x, y + SIDE)])
    return stones


def lines(path: Path, count: int) -> None:
    """Write stones of four lines each as DXF."""
    from ezdxf.filemanagement import new

    drawing = new("R2010", units=4)
    for stone in corners(count // 4):
        for start, end in zip(stone, [*stone[1:], stone[0]], strict=True):
            drawing.modelspace().add_line(start, end, dxfattribs={"layer": "STONES"})
    drawing.saveas(path)


def outlines(path: Path, count: int) -> None:
    """Write stones as closed polylines in DXF."""
    from ezdxf.filemanagement import new

    drawing = new("R2010", units=4)
    for stone in corners(count):
        drawing.modelspace().add_lwpolyline(stone, close=True, dxfattribs={"layer": "STONES"})
    drawing.saveas(path)


def surface(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return corners and triangles of a wavy column on a flat foot."""
    around = max(int((count / 4) ** 0.5), 8)
    up = max(count // (2 * around), 2)
    angle = 2 * np.pi * np.arange(around) / around
    height = np.linspace(0.0, 3.0, up + 1)
    radius = 0.5 + 0.05 * np.sin(4 * height)[:, None] * np.cos(3 * angle)
    rings = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.repeat(height[:, None], around, 1)], axis=2)
    points = np.concatenate([rings.reshape(-1, 3), [[0, 0, 0], [0, 0, 3.0]]])
    k, j = np.meshgrid(np.arange(up), np.arange(around), indexing="ij")
    a, b = (k * around + j).ravel(), (k * around + (j + 1) % around).ravel()
    ring, last = np.arange(around), len(points) - 1
    after = (ring + 1) % around
    top = up * around
    faces = [
        np.stack([a, b, b + around], axis=1), np.stack([a, b + around, a + around], axis=1),
        np.stack([np.full(around, last - 1), after, ring], axis=1),
        np.stack([np.full(around, last), top + ring, top + after], axis=1),
    ]  # fmt: skip
    return points, np.concatenate(faces)


def stl(path: Path, count: int) -> None:
    """Write a column as binary STL."""
    points, faces = surface(count)
    rows = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    rows["corners"] = points[faces]
    path.write_bytes(bytes(80) + struct.pack("<I", len(faces)) + rows.tobytes())


def ply(path: Path, count: int) -> None:
    """Write a column as binary PLY."""
    points, faces = surface(count)
    rows = np.zeros(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(head.encode() + points.astype("<f4").tobytes() + rows.tobytes())


def obj(path: Path, count: int) -> None:
    """Write a column as OBJ."""
    points, faces = surface(count)
    with path.open("w") as file:
        np.savetxt(file, points, "v %.6f %.6f %.6f")
        np.savetxt(file, faces + 1, "f %d %d %d")


CASES: dict[str, tuple[str, int, Callable[[Path, int], None]]] = {
    "lines of DXF": ("lines.dxf", 20_000, lines),
    "closed outlines of DXF": ("outlines.dxf", 2_000, outlines),
    "triangles, binary STL": ("mesh.stl", 1_000_000, stl),
    "triangles, binary PLY": ("mesh.ply", 1_000_000, ply),
    "triangles, OBJ": ("mesh.obj", 1_000_000, obj),
}


def imported(path: Path) -> None:
    """Import a file."""
    if path.suffix == ".dxf":
        rk.import_drawing(path, close="0.5 mm")
    else:
        rk.import_mesh(path, units="m")


def only_read(path: Path) -> None:
    """Read a drawing by ezdxf."""
    from ezdxf.filemanagement import readfile

    readfile(path)


def spent(use: Callable[[Path], None], small: Path, *files: Path) -> tuple[list[float], float]:
    """Return the processor time of each file [s], and the memory that they add [MB]; the small one loads libraries."""
    import resource

    gc.set_threshold(GARBAGE_THRESHOLD)
    use(small)
    before, times = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, []
    for path in files:
        start = time.process_time()
        use(path)
        times.append(time.process_time() - start)
    return times, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024


def main() -> None:
    """Print the table."""
    print("| what | number | s | over half as many | MB | time over `readfile` | memory over `readfile` |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, (file, count, write) in CASES.items():
            paths = [Path(folder) / f"{size}_{file}" for size in (count // 100, count // 2, count)]
            for path, size in zip(paths, (count // 100, count // 2, count), strict=True):
                write(path, size)
            uses = (imported, only_read) if file.endswith(".dxf") else (imported,)
            new, own = multiprocessing.get_context("spawn"), []
            for use in uses:
                with ProcessPoolExecutor(1, new) as pool:
                    own.append(pool.submit(spent, use, *paths).result())
            (half, whole), memory = own[0]
            over = [
                f"{whole / times[1]:.1f} | {f'{memory / more:.1f}' if more > LEAST_MEMORY else ''}"
                for times, more in own[1:]
            ] or ["|"]
            print(f"| {name} | {count:,} | {whole:.2f} | {whole / half:.1f} | {memory:.0f} | {over[0]} |", flush=True)


if __name__ == "__main__":
    main()
