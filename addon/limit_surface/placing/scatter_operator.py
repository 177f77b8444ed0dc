# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts that the operators share which scatter things over a limit surface."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import bpy
import numpy as np

from ..counting import counted
from ..errors import RefusalError
from ..reading import cage, displayed_mesh
from ..sources.source_mesh import Choice
from ..subsurf import setup
from ..tasks import polling, wrapped_text
from ..tasks.job import Job, Progress, part_of
from ..tasks.object_keys import ObjectKey
from ..tasks.properties import LargeCountProperty, draw_summary
from ..tasks.refused_faces import left_out, reasons
from ..tasks.request_size import RequestSize
from ..tasks.watched_operator import WatchedOperator
from . import (
    border_properties,
    distribution_properties,
    following,
    live_binding,
    region,
    roots,
    subsurf_offer,
)
from .all_or_nothing import all_or_nothing
from .border import borders
from .distribution import Expected, Scattered, why_nothing
from .follow_properties import FollowOrLiveProperties, why_it_stays
from .followers import ground_of
from .rotations import WorldSpace

# the parts of the progress at which the locations and the things are made
SCATTERED, MADE = 0.5, 0.9


@dataclass(frozen=True)
class Ground:
    """The surface on which things are scattered, as plain arrays, and their locations."""

    cage: cage.Cage
    region: region.Region
    scattered: Scattered
    shown: displayed_mesh.DisplayedMesh | None  # None: things stand on the limit surface

    @property
    def locations(self) -> roots.Locations:
        return self.scattered.locations

    def evaluate(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns positions and frames. On displayed polygons the frames are still those of the
        limit surface, which has no kinks between polygons.
        """
        surface = self.region.surface
        if self.shown:
            return self.shown.positions(face, uv), surface.frames(face, uv)
        placed = surface.placed_frames(face, uv)
        return placed.position, placed.frame

    def world_frames(self, part: roots.Roots, space: WorldSpace) -> np.ndarray:
        """Returns frames (n, 3, 3) in the world whose last column is the direction of a thing."""
        frame = space.frames(part.frame)
        directions = self.scattered.directions
        return directions.in_world(part.rows, frame[:, :, 2]) if directions else frame

    def frames(self, part: roots.Roots, space: WorldSpace) -> np.ndarray:
        """Returns the same in the surface's own space, where they are rotations."""
        directions = self.scattered.directions
        if directions is None:
            return part.frame
        return directions.in_surface_space(part.rows, part.frame[:, :, 2], space)

    def surface_uv(self) -> np.ndarray | None:
        face, uv = self.locations.face, self.locations.uv.astype(np.float64)
        return self.cage.surface_uv(self.region.surface, face, uv)


class Distributes(Protocol):
    """A Distribution, or what adds to one."""

    @property
    def amount(self) -> str: ...

    def expected(self, region: region.Region) -> Expected: ...

    def scatter(self, region: region.Region, progress: Progress) -> Scattered: ...


@dataclass(frozen=True)
class Order:
    """All that is asked for, read from Blender: the rest of the work needs arrays alone."""

    surface: ObjectKey
    region: region.Region
    distribution: Distributes
    shown: displayed_mesh.DisplayedMesh | None
    size: RequestSize
    binding: following.Request | None  # None: things do not follow the surface by nodes
    is_live: bool  # whether they follow it live

    def ground(self, progress: Progress) -> Ground:
        scattered = self.distribution.scatter(self.region, progress)
        if not len(scattered.locations):
            raise RefusalError(why_nothing(self.region))
        return Ground(self.region.cage, self.region, scattered, self.shown)

    def bound(self, ground: Ground, things: Any) -> following.Bindings | None:
        """Returns what makes the things follow. They follow the limit surface, so that their
        distance from it is kept where they stand on displayed polygons.
        """
        if self.shown and (self.binding or self.is_live):
            things.binding.put_roots_on(self.region.surface)
        return self.binding.compute(ground.locations) if self.binding else None


@dataclass(frozen=True)
class Made:
    surface: ObjectKey
    ground: Ground
    things: Any  # what the function from the operator's `maker` returns
    bindings: following.Bindings | None
    hidden_by: float | None  # how far the displayed mesh is from a surface that it does not show


class ScatterOperator(
    WatchedOperator,
    LargeCountProperty,
    distribution_properties.DistributionProperties,
    FollowOrLiveProperties,
    subsurf_offer.AddSubsurfProperty,
):
    """Mixin for operators that scatter things: distributions, confirmation, binding and reports.

    A subclass names what it makes (`noun`, plural). These are the steps of the work, each within
    one of the steps that `tasks/watched_operator.py` lists, with the class that provides them:

    1. in `invoke` or `start`, `check_properties`: the subclass refuses contradictory properties;
    2. `_order`: ScatterOperator reads the region and the distribution from Blender;
    3. in `invoke`, `_ask`: ScatterOperator has users confirm what is very large, and offers to add
       a Subdivision Surface modifier where there is none;
    4. `maker`: the subclass gives the function that makes its arrays;
    5. in the job, `Order.ground`, the function from step 4, and `Order.bound` for things that
       follow the surface: none of them touches Blender's data;
    6. in `finish`, `add`: the subclass puts the arrays into the file, and returns the new object.
       Until `add` returns it cleans up after itself;
    7. in `finish`, what was found by `Order.bound` is written, so that the object follows. Where
       that fails, the object is removed again;
    8. `_report`: ScatterOperator says what was made.
    """

    bl_options = {"REGISTER", "UNDO", "PRESET"}
    noun = ""
    _why_not_following = ""
    _question = ""  # what a dialog asks while it offers a modifier

    @property
    def too_large(self) -> str:
        return f"There is not enough memory for so many {self.noun}"

    @property
    def cancelled(self) -> str:
        return f"Cancelled: no {self.noun} were made"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.mesh_in_object_mode(cls, context, ground_of(context.active_object))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._guarded(self._ask, context, event)

    def start(self, context: bpy.types.Context) -> set[str]:
        self._question = ""
        return self._begin(context, self._order(context))

    def finish(self, context: bpy.types.Context, made: Made) -> set[str]:
        surface = made.surface.find()
        self.surface = surface.name
        with all_or_nothing(context, surface):
            how = self._put(context, surface, made)
        context.view_layer.update()
        self._report(made, how)
        return {"FINISHED"}

    def _put(self, context: bpy.types.Context, surface: bpy.types.Object, made: Made) -> str:
        """Puts what was made into the file, and returns how it follows."""
        if self._adds_subsurf(surface):
            quality = setup.add(surface, made.ground.cage).quality
            if quality < setup.QUALITY:
                self.report({"WARNING"}, f"Quality is {quality}, {setup.LOW_QUALITY_REASON}")
        ob = self.add(context, surface, made.things)
        return live_binding.have_follow(context, surface, ob, made.bindings, self.follow)

    def maker(self, found: cage.Cage) -> Any:
        """Returns a function of the ground and of progress. It returns what `add` is called with,
        which has a Binding as `binding`, and runs where Blender's data must not be touched.
        """
        raise NotImplementedError

    def add(
        self, context: bpy.types.Context, surface: bpy.types.Object, made: Any
    ) -> bpy.types.Object:
        raise NotImplementedError

    def elements_per_location(self) -> int:
        """Returns the number of vertices or curve points that are made for one location."""
        return 1

    def sources(self) -> Mapping[str, Choice]:
        """Returns what else is to be read from the mesh, by names under which `Region.sources`
        holds it.
        """
        return {}

    def check_properties(self) -> None:
        """Raises RefusalError for properties that contradict each other."""

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if self._question:
            wrapped_text.draw(layout, self._question, "INFO", subsurf_offer.LINE)
            layout.prop(self, "add_subsurf")
            return
        layout.use_property_split = True
        distribution_properties.draw(layout, self.properties, context)
        self.draw_own(layout, self.properties)
        layout.prop(self, "follow")
        ob = distribution_properties.surface_object(self.properties, context)
        if self.add_subsurf or (ob is not None and setup.lacks_subsurf(ob)):
            layout.prop(self, "add_subsurf")
        layout.prop(self, "allow_large")
        draw_summary(layout, self.summary)

    @staticmethod
    def draw_own(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
        """Draws the properties of the subclass. Panels with the settings of the next run call it,
        too.
        """

    def _ask(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Opens a dialog in which the user confirms a very large number, unless that is allowed
        already, or chooses whether the surface gets a modifier that shows it.
        """
        order = self._order(context)
        self._someone_waits = True
        if self._may_offer(order.surface.find()):
            order.size.check(allow_large=True)  # what can never be made is refused at once
            self.add_subsurf = True
            self.surface, self._question = (
                order.surface.name,
                subsurf_offer.question(order.surface.name, order.size),
            )
            self.allow_large = self.allow_large or order.size.is_large
            return subsurf_offer.open_dialog(context, self)
        if order.size.is_large and not self.allow_large:
            # the dialog asks for this consent; if the user declines it, nothing is run
            self.allow_large = True
            return context.window_manager.invoke_confirm(
                self, event, title=self.bl_label, message=f"Make {order.size}?", confirm_text="Make"
            )
        return self._begin(context, order)

    def _begin(self, context: bpy.types.Context, order: Order) -> set[str]:
        order.size.check(self.allow_large)
        self.summary, self.surface = "", order.surface.name
        self.amount = order.distribution.amount  # so that the redo panel shows it
        make = self.maker(order.region.cage)

        def work(progress: Progress) -> Made:
            ground = order.ground(part_of(progress, 0, SCATTERED))
            things = make(ground, part_of(progress, SCATTERED, MADE))
            bindings = order.bound(ground, things)
            is_hidden = not order.region.cage.rules.subsurf and ground.shown is None
            gap = subsurf_offer.gap(order.region) if is_hidden else None
            return Made(order.surface, ground, things, bindings, gap)

        return self.watch(context, Job(work), f"Making {order.size.how_many}")

    def _adds_subsurf(self, ob: bpy.types.Object) -> bool:
        return self.add_subsurf and setup.lacks_subsurf(ob)

    def _may_offer(self, ob: bpy.types.Object) -> bool:
        """Tells whether the user is to be asked about a modifier for this surface."""
        is_settled = self.properties.is_property_set("add_subsurf") or self.target != "LIMIT"
        return setup.lacks_subsurf(ob) and ob.is_editable and not is_settled

    def _order(self, context: bpy.types.Context) -> Order:
        self.check_properties()
        ob, depsgraph = ground_of(context.active_object), context.evaluated_depsgraph_get()
        if not self._adds_subsurf(ob):
            return self._read(ob, depsgraph)
        setup.check_editable(ob)
        with setup.added(ob, cage.read(ob, depsgraph)):
            return self._read(ob, depsgraph)

    def _read(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Order:
        distribution = distribution_properties.distribution(self.properties)
        covered = region.read(
            ob,
            depsgraph,
            distribution_properties.density_choice(self.properties),
            distribution_properties.mask_choice(self.properties),
            self.sources(),
            border_properties.choice(self.properties),
        )
        uv_map = covered.cage.uv_map  # things store their places on it
        self.rely_on(ob, named=[uv_map.name] if uv_map else ())
        expected = distribution.expected(covered)
        size = RequestSize(
            self.noun,
            expected.count,
            self.elements_per_location(),
            expected.is_exact,
            expected.candidates,
        )
        shown = None
        if self.target != "LIMIT":
            shown = displayed_mesh.read(ob, depsgraph, covered.cage, self.target)
        is_live = self.follow == "LIVE"
        if is_live:
            following.check_surface(ob, depsgraph.scene)
        binding = following.request_for(self.follow, ob, depsgraph)
        self._why_not_following = why_it_stays(self.follow, ob)
        return Order(ObjectKey.of(ob), covered, distribution, shown, size, binding, is_live)

    def _report(self, made: Made, how: str) -> None:
        ground = made.ground
        found, refused = ground.cage, ground.region.refused
        faces = ground.region.face_count
        what, apart = counted(len(ground.locations), self.noun), ""
        if ground.scattered.curves:
            what += f" along {borders(ground.scattered.curves)}"
        else:
            what += f" on {counted(faces, 'faces')}"
        if ground.scattered.distance is not None:
            apart = f", at least {ground.scattered.distance:.4g} apart"
        self.summary = what + apart
        if refused:
            warning = left_out(len(refused), len(found.face_sizes), reasons(refused))
            self.report({"WARNING"}, warning)
        notes = [f"{what} of {self.surface}{apart}", *found.notes]
        if ground.scattered.note:
            notes.insert(1, ground.scattered.note)
            self.summary += f"\n{ground.scattered.note}"
        if how:
            notes.append(f"they follow the surface {how}")
        if found.without_uv_map:
            notes.append(f"UVs were not stored: {found.without_uv_map}")
        self.report({"INFO"}, "; ".join(notes))
        if self._why_not_following and not how:
            text = f"{what} do not follow the surface: {self._why_not_following}"
            self.report({"WARNING"}, text)
        if made.hidden_by is not None:
            # the last report is the one that the status bar shows
            self.report({"WARNING"}, subsurf_offer.warning(self.surface, made.hidden_by, self.noun))
            self.summary += f"\n{subsurf_offer.short_warning(made.hidden_by)}"
