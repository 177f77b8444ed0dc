#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of the documentation and fills in its tables of measurements.

    docs/figures/make.py [--list] [--output FOLDER] [--samples COUNT] [NAME ...]

Without names it makes all of them, which takes about half an hour.
"""

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if not __package__:
    # This folder is left out: its modules would hide others of the same names.
    sys.path[:1] = [str(ROOT / "docs"), str(ROOT / "addon")]

from figures import NotDrawnError  # noqa: E402


@dataclass(frozen=True)
class Figure:
    """A function of a module that takes the folder to write to."""

    module: str
    shows: str
    function: str = "make"
    arguments: tuple[str, ...] = ()
    rendered: bool = False  # the function also takes `samples`
    in_blender: bool = False
    folder: Path = ROOT / "docs/images"

    def make(self, folder: Path | None, **options: object) -> None:
        function: Callable[..., None] = getattr(
            import_module(f"figures.{self.module}"), self.function
        )
        function(folder or self.folder, *self.arguments, **options)


def rendered(module: str, shows: str, function: str = "make", *arguments: str) -> Figure:
    return Figure(module, shows, function, arguments, rendered=True, in_blender=True)


def exact(name: str, shows: str) -> Figure:
    return rendered("exactness.pictures", f"Blender's surface and the exact one at {shows}", "make",
                    name)  # fmt: skip


def table(module: str, shows: str, function: str = "make") -> Figure:
    return Figure(module, shows, function, in_blender=True, folder=ROOT / "docs")


#: The figures by the name of the picture's file, or of the table
FIGURES = {
    "figure1": rendered("figure1", "the paper's figure 1: hair on an open mesh's limit surface"),
    "bake_maps": rendered("bake_maps", "a mesh with its normal map, and other baked maps"),
    "border": rendered("border", "lashes, rows and a crease along borders"),
    "children": rendered("children", "children by Blender's node group and by this extension"),
    "curvature": rendered("curvature", "curvature as colours and as principal directions"),
    "density": rendered("distribution", "densities from three sources", "make_densities"),
    "draw": rendered("draw", "a seam, stitches and a cable that were drawn on a sheet"),
    "displacement": rendered("displacement.picture", "a head, a displacement map, and its sculpt"),
    "distribution": rendered("distribution", "the three distributions", "make_distributions"),
    "exact_boundary": exact("boundary", "an extraordinary vertex on the boundary"),
    "exact_cone": exact("cone", "a sharp vertex"),
    "exact_corner": exact("corner", "a smooth corner"),
    "exact_crease": exact("crease", "corners of an infinitely sharp crease"),
    "exact_dart": exact("dart", "a dart"),
    "exact_interior": exact("interior", "an extraordinary vertex inside the mesh"),
    "exact_pole": exact("pole", "a pole of triangles"),
    "exact_polygons": exact("polygons", "triangles and larger faces"),
    "exact_semisharp": exact("semisharp", "a semi-sharp crease"),
    "exact_several": exact("several", "several extraordinary vertices on one face"),
    "exact_uv": exact("uv", "the end of a UV seam"),
    "featured": rendered("extension_page", "hair, 16 : 9", "make_featured"),
    "follow": rendered("follow", "hair on a mesh that bends, and its distance from the surface"),
    "icon": rendered("extension_page", "the icon of the extension", "make_icon"),
    "limit_mesh": rendered("limit_mesh", "meshes by levels and by flatness, and exact normals"),
    "particles": rendered("particles", "hair as particles by Blender and by this extension"),
    "points": rendered("points", "instances that a group, curves and an attribute steer"),
    "presets": rendered("presets", "what each of the shipped presets makes"),
    "project_image": rendered("project_image", "an image projected from a camera, and a decal"),
    "report": rendered("report", "distances from the limit surface at two levels, as colours"),
    "snap": rendered("snap", "objects and hair before and after snapping"),
    "steering": rendered(
        "steering", "strands steered by a group, an image and curves", "make_steering"
    ),
    "hair_nodes": rendered("steering", "Blender's hair nodes on strands", "make_hair_nodes"),
    "eigenbasis_error": Figure("eigenbasis", "errors by valence, as tools/verify_eigenbasis found"),
    "projection": Figure("projection", "a projected checker, and filtered look-ups"),
    "query_rays": Figure("queries", "a picture of 614,400 rays, and its outline", "make_rays"),
    "query_section": Figure("queries", "closest points and hits of rays", "make_sections"),
    "sample_node": Figure("sample_node", "the node Sample Limit Surface", in_blender=True),
    "scatter_points": Figure("scatter", "points of the three distributions", "make_points"),
    "scatter_spectra": Figure("scatter", "spectra of the three distributions", "make_spectra"),
    "uv_locations": Figure("uv", "a UV map inverted, texel by texel"),
    "displacement_table": table("displacement.table", "how closely a map reproduces the sculpt"),
    "exactness_table": table("exactness.pictures", "distances by feature", "make_table"),
    "parity_tables": table("parity.tables", "distances of Blender's meshes, on many meshes"),
}


def main() -> int:
    arguments = parse_arguments()
    if arguments.list:
        for name, figure in FIGURES.items():
            print(f"{name:<19} {figure.shows}")
        return 0
    names = arguments.names or list(FIGURES)
    missing = []
    in_blender = any(FIGURES[name].in_blender for name in names)
    if in_blender:
        import_module("limit_surface").register()
    try:
        for name in names:
            try:
                make(name, arguments)
            except NotDrawnError as reason:
                missing.append(f"{name}: {reason}")
    finally:
        if in_blender:  # with classes still registered, Blender as a module never ends
            import_module("limit_surface").unregister()
    for line in missing:
        print(line, file=sys.stderr)
    return 1 if missing else 0


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0],
        epilog="Without names it makes all of them, which takes about half an hour.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="figures to make; see --list")
    parser.add_argument("--list", action="store_true", help="name all figures, and what they show")
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FOLDER",
        help="write there, not to docs/images (pictures) or docs (pages with tables)",
    )
    parser.add_argument("--samples", type=int, help="per pixel, of pictures that Blender renders")
    parser.add_argument("--width", type=int, help="of figure1, in pixels")
    parser.add_argument("--keep-scene", action="store_true", help="save figure1's scene beside it")
    arguments = parser.parse_args()
    if unknown := sorted(set(arguments.names) - set(FIGURES)):
        parser.error(f"no figure is called {', '.join(unknown)}; --list names them all")
    if (arguments.width or arguments.keep_scene) and arguments.names != ["figure1"]:
        parser.error("--width and --keep-scene are options of figure1 alone")
    return arguments


def make(name: str, arguments: argparse.Namespace) -> None:
    figure = FIGURES[name]
    options = {"samples": arguments.samples} if figure.rendered else {}
    if name == "figure1":
        options |= {"width": arguments.width, "keep_scene": arguments.keep_scene}
    begin = time.perf_counter()
    figure.make(arguments.output, **{key: value for key, value in options.items() if value})
    print(f"{name}: {time.perf_counter() - begin:.1f} s", flush=True)


if __name__ == "__main__":
    sys.exit(main())
