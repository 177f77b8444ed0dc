# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_children_add."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import ids, native
from ..counting import by_count, counted
from ..errors import RefusalError
from ..nodes import children as nodes
from ..placing import all_tiles, followers, following, live_children, new_hair, roots, shown_strands
from ..placing.all_tiles import AllTiles
from ..placing.binding import Binding
from ..placing.distribution import Distribution
from ..placing.distribution_properties import DENSITY, surface_object
from ..placing.follow_properties import follows
from ..placing.new_hair import Strands
from ..placing.rotations import WorldSpace
from ..placing.scatter_operator import Ground, Made, Order, ScatterOperator
from ..reading import cage
from ..reading.named import find_object
from ..sources.source_mesh import Choice
from ..tasks import polling
from ..tasks.job import Progress
from ..tasks.object_keys import ObjectKey
from . import guides as guide_hair
from . import parting
from .spread import Followed, Spread

DEPTH = 16  # of the tables of tiles that are made for live children
# The smallest seed of children. That of guides is smaller, so that no child stands on its guide.
_SEEDS = 1 << 32
# properties that live children do not store: what a run is about, and what it says
_OF_ONE_RUN = {"rna_type", "surface", "guides", "summary", "replaces", "allow_large", "add_subsurf"}


class OBJECT_OT_limit_children_add(ScatterOperator, parting.PartingProperties, bpy.types.Operator):
    """Add strands between the strands of the active hair, which are their guides. Roots lie exactly
    on the limit surface, and each child takes its shape from the guides that are nearest along the
    surface"""

    bl_idname = ids.CHILDREN_ADD
    bl_label = "Add Children on Limit Surface"
    noun = "children"

    # what is read for live children
    _tiles: AllTiles | None = None
    _guides_binding: following.Request | None = None

    _guides_key: ObjectKey | None = None

    mode: EnumProperty(
        name="Mode",
        description="Whether children are curves in the file, or grow live in each frame",
        items=(
            (
                "MADE",
                "Curves",
                "Make curves that you can comb and edit. They do not change when the guides change",
                "",
                0,
            ),
            (
                "LIVE",
                "Live",
                "Let Geometry Nodes grow the strands from the guides as they are in each "
                "frame. This also works without this extension. The file stores only the "
                "children's places and guides",
                "",
                1,
            ),
        ),
        default="MADE",
    )
    guides: StringProperty(
        name="Guides",
        description="Name of the hair whose strands are the guides. If empty, the active hair is "
        "used",
        options={"SKIP_SAVE"},
    )
    guide_count: IntProperty(
        name="Guides per Child",
        description="How many of the nearest guides shape a child",
        default=4,
        min=1,
        max=live_children.MOST_GUIDES,
    )
    points: IntProperty(
        name="Points",
        description="Number of control points on each child, including the root",
        default=8,
        min=2,
        max=1024,
        soft_max=32,
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius of the children in world units",
        default=0.001,
        min=0.0,
        soft_max=0.1,
        precision=4,
        subtype="DISTANCE",
    )
    viewport_share: FloatProperty(
        name="Viewport Share",
        description="Share of the live children that the viewport shows. Renders show all of them",
        default=0.1,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )

    replaces: StringProperty(
        name="Replaces",
        description="Name of the live children to make again. If empty, new ones are made",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.in_object_mode(
            cls,
            context,
            lambda: followers.ground_of(context.active_object) is not None,
            _nothing(context.active_object),
        )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        ob = context.active_object
        if not self.guides and ob is not None and ob.type == "CURVES":
            self.guides = ob.name
        return super().invoke(context, event)

    def elements_per_location(self) -> int:
        return self.points if self.mode == "MADE" else 0

    def check_properties(self) -> None:
        if self.mode == "LIVE" and self.target != "LIMIT":
            raise RefusalError(
                "Live children grow only on the limit surface: choose the mode Curves, or "
                "the limit surface as the target"
            )
        if self.mode == "LIVE" and self.follow == "LIVE":
            raise RefusalError(
                "Live children grow by Geometry Nodes, so they cannot follow in the mode Live, in "
                "which this extension moves things: choose another value of Follow"
            )

    def sources(self) -> Mapping[str, Choice]:
        return {"parting": parting.choice(self.properties, bpy.context)}

    @staticmethod
    def draw_own(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
        layout.prop(properties, "mode")
        layout.prop_search(properties, "guides", bpy.data, "objects")
        for name in ("guide_count", "points", "radius"):
            layout.prop(properties, name)
        if properties.mode == "LIVE":
            layout.prop(properties, "viewport_share")
        parting.draw(layout, properties, surface_object(properties, bpy.context))

    def finish(self, context: bpy.types.Context, made: Made) -> set[str]:
        result = super().finish(context, made)
        binding, self._guides_binding = self._guides_binding, None
        if binding is not None:
            binding.compute().write()
        return result

    def _report(self, made: Made, how: str) -> None:
        followed = made.ground.scattered
        assert isinstance(followed, Followed)
        if self.mode == "LIVE":
            self._why_not_following = ""
            how = f"by Geometry Nodes, as {followed.guides.key.name} shapes them"
        super()._report(made, how)
        texts = [shown_strands.warning_of_types(followed.guides.key.find())]
        if followed.unreached:
            were = counted(followed.unreached, "places", "was", "were")
            them = by_count(followed.unreached, "it", "them")
            texts.append(f"{were} left out: no path along the surface leads from {them} to a guide")
        for text in filter(None, texts):
            self.report({"WARNING"}, text)
            self.summary += f"\n{text}"

    def _settings(self) -> dict[str, Any]:
        """Returns the properties as JSON can hold them, but for those of one run alone."""
        names = self.properties.bl_rna.properties.keys()
        return {
            name: value if isinstance(value, bool | int | float | str) else list(value)
            for name in names
            if name not in _OF_ONE_RUN
            for value in (getattr(self, name),)
        }

    def _local_radius(self, matrix: np.ndarray) -> float:
        return self.radius / WorldSpace(matrix).mean_scale

    def _guides_object(self) -> bpy.types.Object:
        ob = bpy.context.active_object
        if self.guides:
            ob = find_object(self.guides, "hair whose strands guide the children")
        if ob is None or ob.type != "CURVES":
            raise RefusalError("Children need guides: make hair active, or name it as Guides")
        return ob

    def _read(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Order:
        hair = self._guides_object()
        theirs = followers.surface_of(hair)
        if theirs != ob:
            raise RefusalError(
                f"{hair.name} stands on {theirs.name if theirs else 'no surface'}, not on {ob.name}"
            )
        order = super()._read(ob, depsgraph)
        guides = guide_hair.read(hair, ob, order.region.cage, self.points, depsgraph)
        self.rely_on(hair, named=[ids.FACE, ids.UV])
        self._guides_key = ObjectKey.of(hair)
        self.guides = hair.name  # so that the redo panel finds them
        assert isinstance(order.distribution, Distribution)
        own = replace(order.distribution, seed=_SEEDS + order.distribution.seed)
        spread = Spread(own, guides, self.guide_count)
        if self.mode == "LIVE":
            following.check_surface(ob, depsgraph.scene)
            was = all_tiles.settings_of(ob)
            self._tiles = AllTiles(ob, depsgraph, was.depth or DEPTH, was.levels)
            order = replace(order, binding=None)
            is_bound = followers.modifier_of(hair) or followers.live_modifier_of(hair)
            if not is_bound and follows(self.follow, ob):
                self._guides_binding = following.Request(ob, depsgraph, [hair])
        return replace(order, distribution=spread)

    def maker(self, found: cage.Cage) -> Callable[[Ground, Progress], Any]:
        if self.mode == "LIVE":
            return _live_table_of(self._tiles)
        uv_map = found.uv_map.name if found.uv_map else ""
        radius = self._local_radius(found.matrix)

        def make(ground: Ground, progress: Progress) -> Strands:
            return _curves(ground, radius, uv_map, progress)

        return make

    def add(
        self, context: bpy.types.Context, surface: bpy.types.Object, made: Any
    ) -> bpy.types.Object:
        assert self._guides_key is not None  # as `_read` has found
        guides = self._guides_key.find()
        self.guides = guides.name
        if isinstance(made, live_children.Table):
            materials = guides.data.materials
            inputs = {
                nodes.POINTS: self.points,
                nodes.SHARE: self.viewport_share,
                nodes.RADIUS: self._local_radius(np.array(surface.matrix_world)),
                nodes.MATERIAL: materials[0] if len(materials) else None,
            }
            tiles, self._tiles = self._tiles, None
            assert tiles is not None
            settings = self._settings() | DENSITY.names_of_active(self, surface)
            old = bpy.data.objects.get(self.replaces)
            if old is not None:
                live_children.make_again(old, surface, guides, tiles, made, settings)
                return old
            return live_children.add(context, surface, guides, tiles, made, inputs, settings)
        return new_hair.add(context, ids.CHILDREN_OBJECT, surface, made, guides.data.materials)


def _live_table_of(
    tiles: AllTiles | None,
) -> Callable[[Ground, Progress], live_children.Table]:
    """Returns the function that finds the tiles, and makes the table of the children."""

    def make(ground: Ground, progress: Progress) -> live_children.Table:
        assert tiles is not None
        tiles.compute(progress)
        followed = _followed(ground)
        strand = followed.guides.strand[followed.guide]
        return live_children.Table.of(followed.locations, strand, followed.weight)

    return make


def _curves(ground: Ground, radius: float, uv_map: str, progress: Progress) -> Strands:
    """Shapes the children in the world, where an uneven scale of the surface does not bend them."""
    followed = _followed(ground)
    guides, found = followed.guides, ground.region.cage
    space, count = WorldSpace(found.matrix, found.name), len(followed.locations)
    normals = space.frames(found.surface().frames(guides.at.face, guides.at.uv))[:, :, 2]
    binding = Binding(followed.locations)
    position = np.empty((count, *guides.points.shape[1:]), np.float32)
    for part in roots.evaluate(ground.evaluate, followed.locations, progress):
        binding.fill(part)
        shapes = native.limitsurf.child_strands(
            guides.points,
            normals,
            followed.guide[part.rows],
            followed.weight[part.rows],
            np.zeros_like(part.position),
            space.frames(part.frame)[:, :, 2],
        )
        local = space.to_local(shapes.reshape(-1, 3)).reshape(shapes.shape)
        np.add(part.position[:, None], local, out=position[part.rows], casting="same_kind")
    return Strands.equal(binding, position, np.full(count, radius), ground.surface_uv(), uv_map)


def _followed(ground: Ground) -> Followed:
    assert isinstance(ground.scattered, Followed)
    return ground.scattered


def _nothing(active: bpy.types.Object | None) -> str:
    """Returns what to do where the active object is no hair on a surface."""
    if active is not None and active.type == "CURVES" and followers.is_placed(active):
        return followers.why_not_placed(active)
    return "Select hair that stands on a mesh as the active object. Its strands become the guides"
