# SPDX-License-Identifier: GPL-3.0-or-later
"""The arguments of the command."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from . import exporters

_FRAMES = re.compile(r"(-?\d+)(?:-(-?\d+))?")
_LARGEST_FRAME = 1_048_574  # Blender shows this frame instead of later ones

DESCRIPTION = """\
Writes a cache of each object as it is in each frame: DIR/OBJECT.FRAME.abc. Files
that exist already are kept, so run an interrupted bake again to complete it.
"""

EXIT_CODES = """\
exit codes:
  0  all files are there
  1  at least one file could not be written; the others are there
  2  the arguments are wrong, or the folder holds another bake
  3  an object cannot follow its surface; the message names the operator that
     repairs it
"""


@dataclass(frozen=True)
class Arguments:
    frames: range
    objects: tuple[str, ...]  # sorted, each once
    folder: Path
    format: exporters.Format
    overwrite: bool


def parse(argv: Sequence[str]) -> Arguments:
    """Raises SystemExit, as argparse does, where the arguments are wrong or ask for help."""
    found = _parser().parse_args(argv)
    first, last = found.frames
    return Arguments(
        frames=range(first, last + 1, found.step),
        objects=tuple(sorted(set(found.objects))),
        folder=found.output.absolute(),
        format=exporters.FORMATS[found.format],
        overwrite=found.overwrite,
    )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="blender -b FILE --command limit_surface",
        description="Commands of the extension Limit Surface.",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    bake = commands.add_parser(
        "bake",
        help="write a cache of objects, frame by frame",
        description=DESCRIPTION,
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = bake.add_argument
    add(
        "--frames",
        required=True,
        type=_frames,
        metavar="A-B",
        help="first and last frame, or one frame; write --frames=-5-10 where the first is negative",
    )
    add("--step", type=_step, default=1, metavar="N", help="only every N-th frame, counted from A")
    add(
        "--objects",
        required=True,
        nargs="+",
        action="extend",
        metavar="NAME",
        help="names of the objects; write --objects=NAME for one that begins with a dash",
    )
    add(
        "--output",
        required=True,
        type=_folder,
        metavar="DIR",
        help="the folder to write to; made if missing",
    )
    add(
        "--format",
        choices=exporters.FORMATS,
        default="abc",
        help="Alembic, USD, USD as text, or numpy arrays; abc by default",
    )
    add(
        "--overwrite",
        action="store_true",
        help="replace files that exist already; after a change of the .blend file or of what it "
        "links, only if that replaces all frames in DIR",
    )
    return parser


def _frames(text: str) -> tuple[int, int]:
    match = _FRAMES.fullmatch(text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a frame nor a range such as 1-24")
    first = int(match[1])
    last = first if match[2] is None else int(match[2])
    if last < first:
        raise argparse.ArgumentTypeError(f"{text!r} ends before it begins")
    if max(-first, last) > _LARGEST_FRAME:
        raise argparse.ArgumentTypeError(
            f"{text!r}: Blender has no frames before {-_LARGEST_FRAME} or after {_LARGEST_FRAME}"
        )
    return first, last


def _folder(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("it is empty; expected a folder")
    if text.startswith("//"):
        raise argparse.ArgumentTypeError(
            f"{text!r} is relative to the .blend file, which only Blender's own paths can be"
        )
    return Path(text)


def _step(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of frames, 1 or more")
    return int(text)
