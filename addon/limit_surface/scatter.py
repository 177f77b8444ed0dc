# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators that scatter things over a limit surface have in common."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from . import cage, native, roots
from .errors import RefusalError
from .progress import progress_bar
from .request import RequestSize

if TYPE_CHECKING:
    import limitsurf


@dataclass(frozen=True)
class Target:
    """The surface that an operator works on."""

    ob: bpy.types.Object
    cage: cage.Cage
    surface: "limitsurf.LimitSurface"
    locations: roots.Locations

    def surface_uv(self) -> np.ndarray | None:
        """The locations on the UV map of the mesh that the viewport shows, smoothed where that is
        subdivided: where Blender's nodes look for them, on the evaluated mesh."""
        found = self.cage.uv_map
        if found is None:
            return None
        shown = self.surface.face_varying(
            found.values, found.indices, self.cage.shown_uv_interpolation
        )
        return shown.evaluate(self.locations.face, self.locations.uv.astype(np.float64)).value


class ScatterOperator:
    """Mixin: locations by one of the distributions, and the rules of asking and reporting.

    A subclass names what it makes (`noun`, plural) and makes it (`build`); until `build` returns
    it cleans up after itself.
    """

    bl_options = {"REGISTER", "UNDO"}
    noun = ""

    distribution: EnumProperty(
        name="Distribution",
        description="How locations are spread over the surface",
        items=(
            (
                "JITTERED",
                "Jittered",
                "The same number on each face: one at a random place in each cell of a grid",
                "",
                0,
            ),
        ),
        default="JITTERED",
    )
    per_side: IntProperty(
        name="Per Side",
        description="Cells along each side of a face: 20 makes 400 on every face with four "
        "corners, and as many at each corner of any other",
        default=20,
        min=1,
        max=10_000,
        soft_max=100,
    )
    seed: IntProperty(
        name="Seed",
        description="Another seed gives another random arrangement",
        default=0,
        min=0,
    )
    allow_large: BoolProperty(
        name="Allow Large Counts",
        description="Make millions of elements without asking. Scripts need it, as nobody can "
        "answer there",
        default=False,
        options={"SKIP_SAVE"},
    )
    summary: StringProperty(
        name="Result",
        description="What the operator made",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        ob = context.active_object
        if not native.available():
            cls.poll_message_set(f"The native module does not load: {native.reason}")
        elif ob is None or ob.type != "MESH":
            cls.poll_message_set("Make a mesh object active first")
        elif context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
        else:
            return True
        return False

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            size = self._size(_read_cage(context))
        except (RefusalError, *native.errors) as error:
            return self._refuse(error)
        if size.is_large and not self.allow_large:
            self.allow_large = True  # what the dialog asks for; declining it runs nothing
            return context.window_manager.invoke_confirm(
                self, event, title=self.bl_label, message=f"Make {size}?", confirm_text="Make"
            )
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self._run(context)
        except (RefusalError, *native.errors) as error:
            return self._refuse(error)
        except MemoryError:
            return self._refuse(f"Not enough memory for so many {self.noun}")

    def build(
        self, context: bpy.types.Context, target: Target, progress: Callable[[float], None]
    ) -> None:
        raise NotImplementedError

    def elements_per_location(self) -> int:
        """Vertices or curve points that one location becomes."""
        return 1

    def check_properties(self) -> None:
        """Refuses properties that make no sense together."""

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "distribution")
        layout.prop(self, "per_side")
        layout.prop(self, "seed")
        self.draw_own(layout)
        layout.prop(self, "allow_large")
        if self.summary:
            layout.label(text=self.summary, icon="INFO")

    def draw_own(self, layout: bpy.types.UILayout) -> None:
        """The subclass's own properties."""

    def _run(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        self.check_properties()
        found = _read_cage(context)
        size = self._size(found)
        size.check(self.allow_large)
        surface = native.limitsurf.LimitSurface(found.mesh)
        locations = roots.scatter_jittered(surface, self.per_side, self.seed)
        if not len(locations):
            raise RefusalError(f"No face has a limit surface: {_reasons(dict(surface.refused))}")
        target = Target(context.active_object, found, surface, locations)
        with progress_bar(context.window_manager) as progress:
            self.build(context, target, progress)
        self._report(target)
        return {"FINISHED"}

    def _size(self, found: cage.Cage) -> RequestSize:
        count = found.ptex_face_count * self.per_side**2
        return RequestSize(self.noun, count, self.elements_per_location())

    def _refuse(self, reason: object) -> set[str]:
        self.report({"ERROR"}, str(reason))
        return {"CANCELLED"}

    def _report(self, target: Target) -> None:
        refused = dict(target.surface.refused)
        found = target.cage
        faces = len(found.face_sizes) - len(refused)
        self.summary = f"{len(target.locations):,} {self.noun} on {faces:,} faces"
        if refused:
            self.report(
                {"WARNING"},
                f"{len(refused):,} of {len(found.face_sizes):,} faces have no limit surface and "
                f"were left out: {_reasons(refused)}",
            )
        notes = [f"{self.summary} of {target.ob.name}", str(found.rules)]
        if found.ignored:
            notes.append(f"ignored behind {found.rules.subsurf}: {', '.join(found.ignored)}")
        if found.without_uv_map:
            notes.append(f"no UVs stored: {found.without_uv_map}")
        self.report({"INFO"}, "; ".join(notes))


def _read_cage(context: bpy.types.Context) -> cage.Cage:
    return cage.read(context.active_object, context.evaluated_depsgraph_get())


def _reasons(refused: dict[int, str]) -> str:
    """The commonest reasons, each with a face for example."""
    example = {reason: face for face, reason in reversed(refused.items())}
    counted = Counter(refused.values()).most_common()
    parts = [f"{reason} (face {example[reason]}; {n} in all)" for reason, n in counted[:3]]
    if len(counted) > 3:
        parts.append(f"{len(counted) - 3} more reasons")
    return "; ".join(parts)
