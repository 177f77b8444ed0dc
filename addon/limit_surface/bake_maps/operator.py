# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_bake_maps."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .. import ids
from ..errors import RefusalError
from ..images import image_files, image_pixels, texel_places
from ..images.texture_operator import TextureOperator
from ..reading import displayed_mesh
from ..tasks.job import Job, Progress
from . import properties, shading, text
from .inputs import Inputs, tiles_of
from .map_images import Baked, bake
from .maps import IRREGULAR_RADIUS, KINDS, NORMAL_TANGENT, Settings
from .output import Output


class Done(NamedTuple):
    baked: Baked
    output: Output
    flat_faces: int
    remarks: tuple[str, ...]  # warnings about what was baked; some may be empty


class OBJECT_OT_limit_bake_maps(TextureOperator, properties.BakeProperties, bpy.types.Operator):
    """Bake position, normal, curvature and other maps of the active mesh's limit surface into
    images, exactly and without rays"""

    bl_idname = ids.BAKE_MAPS
    bl_label = "Bake Maps of Limit Surface"
    too_large = "There is not enough memory for images of this size"
    cancelled = "Cancelled: nothing was baked"

    def draw_properties(self) -> None:
        properties.draw(self.layout, self.properties)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob, maps = context.active_object, tuple(key for key in KINDS if key in self.maps)
        if not maps:
            raise RefusalError("No map is chosen")
        depsgraph = context.evaluated_depsgraph_get()
        found = texel_places.read_cage(ob, depsgraph, self.uv_map)
        self.rely_on(ob, named=[found.chosen_uv_map.name], placed=self.space == "WORLD")
        size = self.width, self.height
        tiles = (
            tiles_of(found, ob.name, size) if self.tiles == "ALL" else (image_pixels.FIRST_TILE,)
        )
        texel_places.check_size(*size, len(tiles), len(maps), self.allow_large)
        output = self._output(ob, tiles)
        output.check(maps)
        corners, of_renders = None, ""
        if NORMAL_TANGENT in maps:
            if self.target == "RENDER":
                of_renders = displayed_mesh.warning_of_renders(ob)
            corners = shading.read(ob, depsgraph, self.target, found.chosen_uv_map.name)
        inputs = Inputs(
            found,
            ob.name,
            corners,
            in_world=self.space == "WORLD",
            maps=maps,
            settings=Settings(
                self.curvature_range, self.cavity_radius, self.distortion_range, IRREGULAR_RADIUS
            ),
            size=size,
            tiles=tiles,
            all_tiles=self.tiles == "ALL",
            margin=self.margin,
            allow_overlap=self.overlap == "ALLOW",
            is_encoded=not output.kind.is_float,
        )

        def work(progress: Progress) -> Done:
            baked = bake(inputs.order(), progress)
            return Done(baked, output, inputs.flat_faces, (of_renders, inputs.outside))

        return self.watch(context, Job(work), f"Baking {ob.name}")

    def finish(self, _context: bpy.types.Context, made: Done) -> set[str]:
        named, told = made.output.put(made.baked.pixels)
        lines = text.ranges(made.baked)
        self.summary = "\n".join(lines)
        warnings = text.warnings(made.baked, made.flat_faces)
        warnings += filter(None, (*made.remarks, *told))
        warnings += filter(None, (image_pixels.unsaved(image) for image in named))
        if warnings:
            self.report({"WARNING"}, "; ".join(warnings))
        names = ", ".join(image.name for image in named)
        self.report({"INFO"}, "; ".join([texel_places.told(names, made.baked.texels), *lines]))
        return {"FINISHED"}

    def _output(self, ob: bpy.types.Object, tiles: tuple[int, ...]) -> Output:
        return Output(
            name=self.name or ob.name,
            kind=image_files.KINDS[self.format],
            folder=image_files.given_path(self.folder) if self.folder else None,
            reuse=self.reuse,
            tiles=tiles,
            size=(self.width, self.height),
        )
