# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_bake_displacement."""

from __future__ import annotations

import json
from dataclasses import dataclass

import bpy

from .. import ids
from ..counting import by_count, counted
from ..errors import RefusalError
from ..images import (
    image_files,
    image_names,
    image_pixels,
    material_slots,
    overlap,
    texel_places,
    uv_tiles,
)
from ..images.texture_operator import TextureOperator
from ..tasks.job import Job, Progress
from ..tasks.object_keys import ObjectKey
from ..tasks.refused_faces import left_out
from . import layouts, material, properties, surfaces
from .displacement import Measured, Request, measure
from .layouts import PtexLayout
from .output import Output


@dataclass(frozen=True)
class Made:
    surface: ObjectKey
    request: Request
    measured: Measured
    output: Output


class OBJECT_OT_limit_bake_displacement(
    TextureOperator, properties.DisplacementProperties, bpy.types.Operator
):
    """Make a displacement map: an image that turns the limit surface of the active mesh into that
    of the other selected mesh, such as a sculpted copy"""

    bl_idname = ids.BAKE_DISPLACEMENT
    bl_label = "Bake Displacement on Limit Surface"
    too_large = "There is not enough memory for so many texels"
    cancelled = "Cancelled: no image was made or changed"

    def draw_properties(self) -> None:
        properties.draw(self.layout, self.properties)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob = context.active_object
        if self.create_material and self.layout_kind == "PTEX":
            raise RefusalError(
                "A material needs a UV map, which the layout Tile per Face does not use: choose "
                "the layout UV Map, or turn Create Material off"
            )
        if self.create_material:
            material.check(ob)
        both = surfaces.read(self.properties, context, ob)
        in_world = self.transform == "WORLD"
        maps = [both.found.chosen_uv_map.name] if both.uv_data else ()
        self.rely_on(ob, placed=in_world, named=maps)
        self.rely_on(both.target.find(), placed=in_world)
        request = Request(
            surfaces=both,
            layout=layouts.of(self.properties, both, ob.name),
            is_vector=self.mode == "VECTOR",
            in_frames=self.space == "TANGENT",
            max_distance=self.max_distance,
            direction=self.direction,
        )
        output = Output(
            name=self.image_name or image_names.with_ending(ob.name, " Displacement"),
            path=image_files.given_path(self.filepath) if self.filepath else None,
            reuse=self.reuse,
            tiles=tuple(request.layout.tiles),
            size=(request.layout.width, request.layout.height),
        )
        output.check()
        key = ObjectKey.of(ob)

        def work(progress: Progress) -> Made:
            return Made(key, request, measure(request, progress), output)

        return self.watch(context, Job(work), f"Displacing {ob.name}")

    def finish(self, _context: bpy.types.Context, made: Made) -> set[str]:
        ob, request, measured = made.surface.find(), made.request, made.measured
        image, told = made.output.put(measured.tiles)
        image[ids.DISPLACEMENT] = json.dumps(self._described(request))
        if self.create_material:
            map_name = request.surfaces.found.chosen_uv_map.name
            shown_by = material.show(
                ob, image, map_name, is_vector=request.is_vector, space=self._space
            )
            unseen = material_slots.unseen(ob, shown_by)
            if unseen:
                self.report({"WARNING"}, unseen)
            self._warn_of_tangents(ob, map_name, request)
        for warning in filter(None, (self._outside(request), *told, image_pixels.unsaved(image))):
            self.report({"WARNING"}, warning)
        self._tell(ob, image, request, measured)
        return {"FINISHED"}

    @property
    def _space(self) -> str:
        return self.space if self.mode == "VECTOR" else "OBJECT"

    def _described(self, request: Request) -> dict[str, object]:
        """Stores with the image what its numbers mean, for programs that read it."""
        told: dict[str, object] = {"mode": self.mode, "space": self._space}
        if isinstance(request.layout, PtexLayout):
            return {**told, "layout": "PTEX", **request.layout.described()}
        return {**told, "layout": "UV", "uv_map": request.surfaces.found.chosen_uv_map.name}

    def _outside(self, request: Request) -> str:
        """Returns a warning about the faces outside the image's tiles, or none."""
        if isinstance(request.layout, PtexLayout):
            return ""
        tiles = None if self.use_tiles else request.layout.tiles
        size = request.layout.width, request.layout.height
        return uv_tiles.told(uv_tiles.faces_outside(request.surfaces.found, size, tiles), tiles)

    def _warn_of_tangents(self, ob: bpy.types.Object, map_name: str, request: Request) -> None:
        """Warns where the node for vectors would use another UV map: it always takes tangents from
        the one that is active for rendering.
        """
        rendered = next((layer.name for layer in ob.data.uv_layers if layer.active_render), "")
        if request.is_vector and self.space == "TANGENT" and rendered != map_name:
            self.report(
                {"WARNING"},
                f"Renders take tangents from the UV map {rendered}: make {map_name} the one that "
                "is active for rendering",
            )

    def _tell(
        self, ob: bpy.types.Object, image: bpy.types.Image, request: Request, measured: Measured
    ) -> None:
        base = request.surfaces.base
        if base.refused:
            faces = len(request.surfaces.found.face_sizes)
            self.report({"WARNING"}, left_out(len(base.refused), faces))
        if measured.missing:
            self.report(
                {"WARNING"},
                f"{request.surfaces.target.name} was not found along the normals of "
                f"{measured.missing:,} of {counted(measured.count, 'texels')}: "
                f"{by_count(measured.missing, 'this texel holds', 'these texels hold')} 0",
            )
        if measured.overlapping:
            self.report({"WARNING"}, f"{ob.name}: {overlap.told(measured.overlapping)}")
        what = "lengths" if request.is_vector else "distances"
        is_mapped = not isinstance(request.layout, PtexLayout)
        lines = [
            texel_places.told(image.name, measured.count, is_mapped=is_mapped),
            f"{what} {measured.lowest:.4g} to {measured.highest:.4g}",
        ]
        self.summary = "\n".join(lines)
        notes = request.surfaces.found.notes
        self.report({"INFO"}, "; ".join([f"{ob.name}: {', '.join(lines)}", *notes]))
