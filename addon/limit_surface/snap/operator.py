# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_snap."""

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty

from .. import ids, native
from ..counting import counted
from ..errors import RefusalError
from ..placing.follow_properties import FollowSnappedProperties
from ..tasks.job import Progress, part_of
from ..tasks.piecewise_job import Pieces, PiecewiseJob, aside
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator
from .aim import Aim, Elements, Placement, View
from .binding_again import bind_again
from .choices import Choices, Outcome, merged
from .properties import PlacingProperties
from .selection import HAIR_MODES, MODES, check_target, find_target, gather
from .surface import TargetSurface


class OBJECT_OT_limit_snap(
    PlacingProperties, FollowSnappedProperties, WatchedOperator, bpy.types.Operator
):
    """Move the selected objects and hair onto the exact limit surface of the active mesh. Outside
    Object Mode, move the selected vertices, points, bones or strands onto the limit surface of the
    target in the sidebar tab Limit"""

    bl_idname = ids.SNAP
    bl_label = "Snap to Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many elements"
    cancelled = "Cancelled: nothing was snapped"

    mode: EnumProperty(
        name="Mode",
        description="How the point on the surface is found",
        items=(
            ("NEAREST", "Nearest", "Move to the closest point in world space", 0),
            ("AXIS", "Axis", "Move along an axis", 1),
            (
                "NORMAL",
                "Own Normal",
                "Move along each element's own direction: an object's Z axis, a vertex's normal, "
                "a strand's direction at its root, a bone's direction, or the object's Z axis "
                "for other points",
                2,
            ),
        ),
    )
    axis: EnumProperty(
        name="Axis",
        description="Axis to move along",
        items=tuple((name, name, f"Move along the {name} axis", i) for i, name in enumerate("XYZ")),
        default="Z",
    )
    orientation: EnumProperty(
        name="Orientation",
        description="Coordinate system of the axis",
        items=(
            ("GLOBAL", "Global", "Use the axis of the world", 0),
            ("LOCAL", "Local", "Use the axis of each object or bone", 1),
            (
                "VIEW",
                "View",
                "Use the axis of the 3D viewport. Z is the line of sight through each element",
                2,
            ),
        ),
    )
    direction: EnumProperty(
        name="Direction",
        description="Direction along the axis or normal in which the surface is searched for",
        items=(
            ("BOTH", "Both", "Search both ways and take the closer point", 0),
            ("POSITIVE", "Positive", "Search along the axis or normal", 1),
            ("NEGATIVE", "Negative", "Search against the axis or normal", 2),
        ),
    )
    max_distance: FloatProperty(
        name="Maximum Distance",
        description="Largest distance to the surface. Elements that are farther away do not move. "
        "0 sets no limit",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    use_facing: BoolProperty(
        name="Facing",
        description="Snap only to places where the surface normal is close to the element's own "
        "direction, so that nothing moves through a thin sheet to its other side",
        default=False,
    )
    max_angle: FloatProperty(
        name="Maximum Angle",
        description="Largest angle between the surface normal and the element's own direction",
        default=np.pi / 2,
        min=0.0,
        max=np.pi,
        subtype="ANGLE",
    )
    children: EnumProperty(
        name="Children",
        description="What happens to the children of the objects that move",
        items=(
            ("MOVE", "Move", "Move the children with their parents", 0),
            ("KEEP", "Keep", "Keep the children where they are", 1),
        ),
    )
    keep_length: BoolProperty(
        name="Keep Length",
        description="Keep the length of each strand and of each of its segments",
        default=False,
    )
    view_matrix: FloatVectorProperty(
        name="View Matrix",
        description="For scripts, if the axes are those of the view: the matrix from world "
        "to view. If it is not set, that of the 3D viewport is used",
        size=(4, 4),
        subtype="MATRIX",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    view_is_perspective: BoolProperty(
        name="View Is Perspective",
        description="For scripts, if the axis is the Z axis of the view: whether the view is "
        "a perspective one",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = _obstacle(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        return self.watch(context, PiecewiseJob(self._pieces(context)), "Snapping")

    def finish(self, _context: bpy.types.Context, made: set[str]) -> set[str]:
        return made

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "mode")
        if self.mode == "AXIS":
            layout.prop(self, "axis", expand=True)
            layout.prop(self, "orientation")
        if self.mode != "NEAREST":
            layout.prop(self, "direction")
        layout.prop(self, "max_distance")
        if self.mode == "NEAREST":
            layout.prop(self, "use_facing")
            row = layout.row()
            row.active = self.use_facing
            row.prop(self, "max_angle")
        layout.prop(self, "offset")
        layout.prop(self, "align")
        if context.mode == "OBJECT":
            layout.prop(self, "children")
        if context.mode in ("OBJECT", *HAIR_MODES):
            layout.prop(self, "hair")
            row = layout.row()
            row.active = self.hair != "STRAND"
            row.prop(self, "keep_length")
            layout.prop(self, "follow")
        layout.prop(self, "target")
        draw_summary(layout, self.summary)

    def _pieces(self, context: bpy.types.Context) -> Pieces:
        """Finds all places, and moves everything in the last piece. Returns what the operator
        returns.
        """
        aim = self._aim(context)
        keeps_children = self.children == "KEEP"
        choices = Choices(self.align, keeps_children, self.hair, self.keep_length, self.follow)
        target = find_target(context)
        check_target(context, target)
        surface = TargetSurface(target, context.evaluated_depsgraph_get(), self.target)
        selection = gather(context, surface)
        parts = selection.parts
        self.rely_on(target, placed=True)
        self._rely_on_snapped(context, target)
        placements = []
        for i, part in enumerate(parts):
            elements = part.elements()
            aim.read(elements)

            def place(progress: Progress, i: int = i, elements: Elements = elements) -> Placement:
                of_all = part_of(progress, i / len(parts), (i + 1) / len(parts))
                return aim.place(surface, elements, parts[i].stores_location, of_all)

            placements.append((yield from aside(place)))
        outcomes = [Outcome("objects", failures=+selection.failures)]
        for part, placement in zip(parts, placements, strict=True):
            placed = len(placement.rows) > 0
            outcome = part.place(placement, choices) if placed else Outcome(part.noun)
            outcome.failures += placement.failures
            outcomes.append(outcome)
        followers = [
            part.follower
            for part, placement in zip(parts, placements, strict=True)
            if part.follower and len(placement.rows)
        ]
        for warning in bind_again(followers, target, context, self.follow):
            self.report({"WARNING"}, warning)
        return self._report(surface, context.evaluated_depsgraph_get(), merged(outcomes))

    def _rely_on_snapped(self, context: bpy.types.Context, target: bpy.types.Object) -> None:
        """Of whole objects only the place counts; of others also what is moved within them."""
        is_whole = context.mode == "OBJECT"
        for ob in context.selected_objects if is_whole else context.objects_in_mode_unique_data:
            moves_within = not is_whole or ob.type == "CURVES"
            if ob != target:
                self.rely_on(ob, data=moves_within, shape=moves_within, placed=True)

    def _aim(self, context: bpy.types.Context) -> Aim:
        by_view = self.mode == "AXIS" and self.orientation == "VIEW"
        return Aim(
            mode=self.mode,
            axis="XYZ".index(self.axis),
            orientation=self.orientation,
            direction=self.direction,
            max_distance=self.max_distance or np.inf,
            # a property in single precision exceeds pi where it is 180 degrees
            max_angle=min(self.max_angle, np.pi) if self.use_facing else None,
            offset=self.offset,
            view=self._view(context) if by_view else None,
        )

    def _view(self, context: bpy.types.Context) -> View:
        region = context.region_data
        if not np.any(self.view_matrix) and region is not None:
            self.view_matrix = region.view_matrix
            self.view_is_perspective = region.is_perspective
        if not np.any(self.view_matrix):
            raise RefusalError("There is no 3D viewport whose axes could be used")
        matrix = np.linalg.inv(np.array(self.view_matrix, np.float64))
        return View(matrix[:3, :3], matrix[:3, 3] if self.view_is_perspective else None)

    def _report(
        self,
        surface: TargetSurface,
        depsgraph: bpy.types.Depsgraph,
        outcomes: list[Outcome],
    ) -> set[str]:
        failed = [
            f"{counted(outcome.failed, outcome.noun)} could not be snapped: {outcome.reasons()}"
            for outcome in outcomes
            if outcome.failed
        ]
        done = [outcome for outcome in outcomes if outcome.placed]
        if not done:
            raise RefusalError(". ".join(failed) or "Nothing that can be snapped is selected")
        self.summary = "\n".join(line for outcome in done for line in outcome.lines())
        if failed:
            self.report({"WARNING"}, ". ".join(failed))
        if surface.has_changed(depsgraph):
            self.report(
                {"WARNING"},
                f"{surface.ob.name} moved with the snapped elements, which are not on it now: its "
                "constraints, drivers or modifiers depend on them",
            )
        found = surface.cage
        notes = [f"{', '.join(outcome.lines())} (to {surface.ob.name})" for outcome in done]
        notes += found.notes
        notes += [note for outcome in outcomes for note in outcome.notes]
        self.report({"INFO"}, "; ".join(notes))
        return {"FINISHED"}


def _obstacle(context: bpy.types.Context) -> str:
    """Returns the reason why there is nothing to do, or None."""
    if not native.available():
        return native.obstacle()
    if context.mode not in MODES:
        return (
            "Only available in Object Mode, in Edit Mode of meshes, curves, surfaces, lattices, "
            "armatures and hair, and in Sculpt Mode of hair"
        )
    target = find_target(context)
    if context.mode == "OBJECT":
        if target is None or target.type != "MESH":
            return "Select the objects to snap, and then the mesh as the active object"
        if all(ob == target for ob in context.selected_objects):
            return "Select the objects to snap in addition to the active mesh"
    elif target is None:
        return "Choose a target in the sidebar tab Limit"
    elif target.type != "MESH":
        return "The target in the sidebar tab Limit is not a mesh"
    return ""
