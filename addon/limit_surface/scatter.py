# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators that scatter things over a limit surface have in common."""

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from . import cage, displayed, native, objects, roots
from .distribution import properties, region
from .distribution.spread import Scattered, Spread
from .errors import RefusalError
from .job import Job, Progress, part_of
from .progress import Waiting, progress_bar
from .request import RequestSize

SCATTERED = 0.5  # of the progress, when the locations are there

#: Long work lets the user wait, and watch it, from here on
PATIENCE = 0.3  # seconds

VIEW_NAVIGATION = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "NDOF_MOTION"}


@dataclass(frozen=True)
class Ground:
    """What things are scattered over, as plain arrays, with their places."""

    cage: cage.Cage
    region: region.Region
    scattered: Scattered
    shown: displayed.DisplayedMesh | None  # None: things stand on the surface itself

    @property
    def locations(self) -> roots.Locations:
        return self.scattered.locations

    def evaluate(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions and frames. On the polygons that are shown frames are the surface's all the
        same: there are no kinks in them."""
        surface = self.region.surface
        on = self.shown.positions(face, uv) if self.shown else surface.evaluate(face, uv).position
        return on, surface.frames(face, uv)

    def surface_uv(self) -> np.ndarray | None:
        """The locations on the UV map of the mesh that the viewport shows, smoothed where that is
        subdivided: where Blender's nodes look for them, on the evaluated mesh."""
        found = self.cage.uv_map
        if found is None:
            return None
        smoothed = self.region.surface.face_varying(
            found.values, found.indices, self.cage.shown_uv_interpolation
        )
        return smoothed.evaluate(self.locations.face, self.locations.uv.astype(np.float64)).value


@dataclass(frozen=True)
class Order:
    """All that is asked for, read from Blender: the rest needs arrays alone."""

    surface: tuple[str, str | None]  # the object's key
    region: region.Region
    spread: Spread
    shown: displayed.DisplayedMesh | None
    size: RequestSize

    def ground(self, progress: Progress) -> Ground:
        scattered = self.spread.scatter(self.region, progress)
        if not len(scattered.locations):
            raise RefusalError("The density is too low: nothing is made")
        return Ground(self.region.cage, self.region, scattered, self.shown)


class ScatterOperator(properties.DistributionProperties):
    """Mixin: locations by one of the distributions, and the rules of asking, waiting and reporting.

    A subclass names what it makes (`noun`, plural) and makes it in two steps: `maker` gives a
    function that makes arrays, which may run in a thread of its own, and `add` puts them into the
    file. Until `add` returns it cleans up after itself.
    """

    bl_options = {"REGISTER", "UNDO"}
    noun = ""

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

    _someone_waits = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not native.available():
            cls.poll_message_set(f"The native module does not load: {native.reason}")
        elif _surface_object(context) is None:
            cls.poll_message_set("Make a mesh object active first")
        elif context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
        else:
            return True
        return False

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._guarded(self._invoke, context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self._guarded(self._execute, context)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"Cancelled: no {self.noun} were made")
            return {"CANCELLED"}
        if event.type in VIEW_NAVIGATION:
            return {"PASS_THROUGH"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        self._waiting.show(self._job.part)
        if not self._job.is_done:
            return {"RUNNING_MODAL"}
        self._waiting.end()
        return self._guarded(self._finish, context)

    def cancel(self, _context: bpy.types.Context) -> None:
        """By the user; also if another file is loaded, or Blender quits."""
        self._job.cancel()
        self._job = None
        self._waiting.end()

    def maker(self, found: cage.Cage) -> Any:
        """A function of the ground and of progress, that makes what `add` gets. It is called
        where nothing of Blender may be touched."""
        raise NotImplementedError

    def add(self, context: bpy.types.Context, surface: bpy.types.Object, made: Any) -> None:
        raise NotImplementedError

    def elements_per_location(self) -> int:
        """Vertices or curve points that one location becomes."""
        return 1

    def check_properties(self) -> None:
        """Refuses properties that make no sense together."""

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        properties.draw(layout, self.properties, context)
        self.draw_own(layout)
        layout.prop(self, "allow_large")
        if self.summary:
            layout.label(text=self.summary, icon="INFO")

    def draw_own(self, layout: bpy.types.UILayout) -> None:
        """The subclass's own properties."""

    def _guarded(self, step: Any, *arguments: Any) -> set[str]:
        try:
            return step(*arguments)
        except (RefusalError, *native.errors) as error:
            return self._refuse(error)
        except MemoryError:
            return self._refuse(f"Not enough memory for so many {self.noun}")

    def _invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        order = self._order(context)
        self._someone_waits = True
        if order.size.is_large and not self.allow_large:
            self.allow_large = True  # what the dialog asks for; declining it runs nothing
            return context.window_manager.invoke_confirm(
                self, event, title=self.bl_label, message=f"Make {order.size}?", confirm_text="Make"
            )
        return self._start(context, order)

    def _execute(self, context: bpy.types.Context) -> set[str]:
        order = self._order(context)
        order.size.check(self.allow_large)
        return self._start(context, order)

    def _start(self, context: bpy.types.Context, order: Order) -> set[str]:
        self.summary, self.surface = "", order.surface[0]
        self.amount = order.spread.amount  # the redo panel shows it
        make = self.maker(order.region.cage)

        def work(progress: Progress) -> tuple[Ground, Any]:
            ground = order.ground(part_of(progress, 0, SCATTERED))
            return ground, make(ground, part_of(progress, SCATTERED, 1))

        job = Job(work)
        someone_waits, self._someone_waits = self._someone_waits, False
        self._job, self._surface_key = job, order.surface
        if not (someone_waits and context.window):
            with progress_bar(context.window_manager) as show:
                job.run(show)
            return self._finish(context)
        job.start()
        if job.wait(PATIENCE):
            return self._finish(context)
        self._waiting = Waiting(context, f"Making {order.size.how_many}")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _finish(self, context: bpy.types.Context) -> set[str]:
        job, self._job = self._job, None  # Blender keeps operators, for the redo panel
        ground, made = job.result()
        self.add(context, objects.find(self._surface_key), made)
        self._report(ground)
        return {"FINISHED"}

    def _order(self, context: bpy.types.Context) -> Order:
        self.check_properties()
        ob, depsgraph = _surface_object(context), context.evaluated_depsgraph_get()
        spread = properties.spread(self.properties)
        covered = region.read(
            ob,
            depsgraph,
            properties.density_choice(self.properties),
            properties.mask_choice(self.properties),
        )
        expected = spread.expected(covered)
        size = RequestSize(
            self.noun, expected.count, self.elements_per_location(), expected.is_exact
        )
        shown = None
        if self.target != "LIMIT":
            shown = displayed.read(ob, depsgraph, covered.cage, self.target)
        return Order(objects.key(ob), covered, spread, shown, size)

    def _refuse(self, reason: object) -> set[str]:
        self.report({"ERROR"}, str(reason))
        return {"CANCELLED"}

    def _report(self, ground: Ground) -> None:
        found, refused = ground.cage, ground.region.refused
        faces = ground.region.face_count
        self.summary = f"{len(ground.locations):,} {self.noun} on {faces:,} faces"
        if ground.scattered.distance is not None:
            self.summary += f", at least {ground.scattered.distance:.4g} apart"
        if refused:
            self.report(
                {"WARNING"},
                f"{len(refused):,} of {len(found.face_sizes):,} faces have no limit surface and "
                f"were left out: {region.reasons(refused)}",
            )
        notes = [f"{self.summary} of {self.surface}", str(found.rules)]
        if found.ignored:
            notes.append(f"ignored behind {found.rules.subsurf}: {', '.join(found.ignored)}")
        if found.without_uv_map:
            notes.append(f"no UVs stored: {found.without_uv_map}")
        self.report({"INFO"}, "; ".join(notes))


def _surface_object(context: bpy.types.Context) -> bpy.types.Object | None:
    """The active mesh, or the one that the active hair is on: new hair is active, and Blender asks
    `poll` before it undoes what is to be made anew with other settings."""
    ob = context.active_object
    if ob is not None and ob.type == "CURVES":
        ob = ob.data.surface
    return ob if ob is not None and ob.type == "MESH" else None
