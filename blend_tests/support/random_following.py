# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that follow surfaces by nodes and live, while an artist changes the file in random order:
after each step they must be where the limit surface is.

    python random_following.py SEED STEPS FOLDER

Prints each step, and ends with an error at the first one that raises anything but a refusal, after
which something is elsewhere, or whose result is another one when everything is read anew. FOLDER is
where files are saved.
"""

import random_steps  # sets the paths of the modules below  # isort: skip
import bpy
import follow_scenes
import followed_places
import numpy as np
from contents import digest
from limit_surface import ids
from limit_surface.placing import followers, live_kept
from limit_surface.reading import attributes
from random_steps import LeftWrongError, differences, enter_object_mode, push

FIRST, LAST = 1, 30  # the frames in which surfaces deform
MOST_THINGS = 8


class Following(random_steps.Session):
    def __init__(self, seed: int, folder: random_steps.Path) -> None:
        super().__init__(seed, folder)
        self.steps = [
            (8, self.add_mesh),
            (20, self.add_thing),
            (10, self.add_children),
            (3, self.add_curve),
            (12, self.follow),
            (6, self.unbind_or_rebind),
            (6, self.snap),
            (4, self.attach),
            (16, self.change_frame),
            (10, self.move_object),
            (8, self.edit_mesh),
            (10, self.comb),
            (4, self.remove_strands),
            (4, self.join),
            (5, self.duplicate),
            (3, self.change_mode),
            (8, self.undo_or_redo),
            (3, self.save_and_load),
            (2, self.delete),
            (2, self.rename),
        ]

    def add_mesh(self) -> str:
        if len(bpy.data.objects) > random_steps.MOST_OBJECTS:
            return self.delete(half=True)
        if not enter_object_mode():
            return "not in this mode"
        bpy.ops.object.select_all(action="DESELECT")
        kind = self.random.choice(("cross", "grid with holes", "mixed polygons"))
        ob = follow_scenes.deforming(kind, mirrored=self.random.random() < 0.3)
        if self.random.random() < 0.3:
            ob.modifiers.remove(ob.modifiers["Subdivision"])
        push("mesh")
        return ob.name

    def add_thing(self) -> str:
        surfaces = _surfaces()
        if not surfaces or not enter_object_mode() or len(_things()) > MOST_THINGS:
            return "nothing to stand on"
        surface = self.random.choice(surfaces)
        name = surface.name
        self.select(surface)
        follow = self.random.choice(("NONE", "NODES", "AUTO"))
        kind = self.random.choice((ids.HAIR_ADD, ids.HAIR_ADD, ids.POINTS_ADD, ids.LIMIT_MESH))
        given = {"levels": 1, "store_locations": True} if kind == ids.LIMIT_MESH else {}
        done = self.run(kind, follow=follow, **given or {"per_side": 2})
        if not done.endswith("refused") and followed_places.are_elsewhere(bpy.context.object):
            raise LeftWrongError(f"what was added to {name} does not stand where it should")
        return f"{done} on {name}"

    def add_children(self) -> str:
        guides = [ob for ob in _things() if ob.type == "CURVES" and len(ob.data.curves) > 2]
        if not guides or not enter_object_mode() or len(bpy.data.objects) > 20:
            return "no guides"
        self.select(self.random.choice(guides))
        return self.run(
            ids.CHILDREN_ADD,
            mode=self.random.choice(("LIVE", "LIVE", "MADE")),
            follow=self.random.choice(("AUTO", "NODES", "NONE")),
            distribution="UNIFORM",
            count=20,
            points=self.random.choice((4, 8)),
            viewport_share=1,
        )

    def add_curve(self) -> str:
        """Adds a Curve object somewhere, and has it follow by nodes."""
        surfaces = _surfaces()
        if not surfaces or not enter_object_mode() or len(bpy.data.objects) > 20:
            return "nothing to follow"
        data = bpy.data.curves.new("Curve", "CURVE")
        data.dimensions = "3D"
        for count in (2, 5):
            spline = data.splines.new("POLY")
            spline.points.add(count - 1)
            for point in spline.points:
                point.co[:3] = [self.random.uniform(-1, 1) for _ in range(3)]
        ob = bpy.data.objects.new("Curve", data)
        bpy.context.collection.objects.link(ob)
        ob.location = [self.random.uniform(-1, 1) for _ in range(3)]
        push("curve")
        surface = self.random.choice(surfaces)
        name = surface.name
        self.select(ob, surface)
        return f"{self.run(ids.FOLLOW, mode='NODES')} on {name}"

    def follow(self) -> str:
        things = _things()
        if not things or not enter_object_mode():
            return "nothing follows"
        chosen = self.random.sample(things, self.random.randint(1, min(3, len(things))))
        self.select(*chosen)
        return self.run(ids.FOLLOW, mode=self.random.choice(("LIVE", "NODES")))

    def unbind_or_rebind(self) -> str:
        things = _things()
        if not things or not enter_object_mode():
            return "nothing follows"
        self.select(self.random.choice(things))
        if self.random.random() < 0.5:
            return self.run(ids.UNBIND, shape=self.random.choice(("SHOWN", "REST")))
        return self.run(ids.REBIND, method=self.random.choice(("FACE", "CLOSEST")))

    def snap(self) -> str:
        """Puts hair onto another surface, or back onto its own."""
        hair, surfaces = _visible("CURVES"), _surfaces()
        if not hair or not surfaces or not enter_object_mode():
            return "nothing to snap"
        self.select(self.random.choice(hair), self.random.choice(surfaces))
        return self.run(ids.SNAP, follow=self.random.choice(("AUTO", "NODES", "LIVE", "NONE")))

    def attach(self) -> str:
        surfaces = _surfaces()
        if not surfaces or not enter_object_mode() or len(bpy.data.objects) > 20:
            return "nothing to attach to"
        empty = bpy.data.objects.new("Attached", None)
        bpy.context.collection.objects.link(empty)
        empty.location = [self.random.uniform(-1, 1) for _ in range(3)]
        surface = self.random.choice(surfaces)
        push("empty")
        self.select(empty, surface)
        return self.run(ids.ATTACH)

    def change_frame(self) -> str:
        frame = self.random.choice((FIRST, LAST, self.random.randint(FIRST, LAST)))
        subframe = self.random.choice((0.0, 0.0, 0.25))
        bpy.context.scene.frame_set(frame, subframe=subframe)
        return f"{frame} + {subframe}"

    def move_object(self) -> str:
        movable = [ob for ob in bpy.context.view_layer.objects if ob.library is None]
        if not movable or not enter_object_mode():
            return "nothing to move"
        ob = self.random.choice(movable)
        kind = self.random.choice(("location", "rotation_euler", "scale"))
        low, high = (0.6, 1.6) if kind == "scale" else (-1, 1)
        setattr(ob, kind, [self.random.uniform(low, high) for _ in range(3)])
        push("move")
        return f"{ob.name} {kind}"

    def edit_mesh(self) -> str:
        done = super().edit_mesh()
        take_up_edits()
        return done

    def comb(self) -> str:
        """Moves some of a thing's points, as artists comb hair."""
        things = [ob for ob in _things() if ob.data.library is None and ob.mode == "OBJECT"]
        things = [ob for ob in things if ob.type != "CURVE"]
        if not things or not enter_object_mode():
            return "nothing to comb"
        data = self.random.choice(things).data
        points = attributes.read(data, ids.POSITION)
        moved = np.random.default_rng(self.random.randrange(1 << 30)).random(len(points)) < 0.3
        points[moved] += [0, 0, 0.02]
        attributes.write(data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
        data.update_tag()
        take_up_edits()
        push("comb")
        return data.name

    def remove_strands(self) -> str:
        hair = [ob for ob in _things() if ob.type == "CURVES" and len(ob.data.curves) > 8]
        if not hair or not enter_object_mode() or not hasattr(hair[0].data, "remove_curves"):
            return "nothing to remove"
        data = self.random.choice(hair).data
        doomed = self.random.sample(range(len(data.curves)), 4)
        data.remove_curves(indices=sorted(doomed))
        push("remove strands")
        return data.name

    def join(self) -> str:
        """Joins hair of one surface, and has it follow, as the documentation asks for."""
        hair = [ob for ob in _things() if ob.type == "CURVES"]
        pairs = [(a, b) for a in hair for b in hair if a != b and _can_join(a, b)]
        if not pairs or not enter_object_mode():
            return "nothing to join"
        chosen = self.random.choice(pairs)
        self.select(*chosen)
        try:
            bpy.ops.object.join("EXEC_DEFAULT", True)
        except RuntimeError:  # they share their data
            return "could not be joined"
        push("join")
        name = bpy.context.object.name
        done = self.run(ids.FOLLOW, mode=self.random.choice(("LIVE", "NODES")))
        if done.endswith("refused"):  # a part was bound before the faces changed
            bpy.data.objects.remove(bpy.data.objects[name])
            push("remove")
        return f"{name} {done}"

    def select(self, *obs: bpy.types.Object) -> None:
        bpy.ops.object.select_all(action="DESELECT")
        for ob in obs:
            ob.select_set(True)
            bpy.context.view_layer.objects.active = ob
        push("selection")

    def run(self, name: str, **properties: object) -> str:
        area, _, verb = name.partition(".")
        before = digest()
        try:
            getattr(getattr(bpy.ops, area), verb)("EXEC_DEFAULT", True, **properties)
        except RuntimeError as error:
            if "Traceback" in str(error):
                raise
            return f"{verb} {properties}: refused"
        self.check_undo(f"{name} {properties}", before)
        return f"{verb} {properties}"

    def undo_or_redo(self) -> str:
        done = super().undo_or_redo()
        show_frame()
        return done

    def evaluate_animation(self) -> None:
        show_frame()

    def check(self) -> None:
        super().check()
        if bpy.context.mode != "OBJECT":
            return
        bpy.context.view_layer.update()
        before = digest()
        live_kept.forget()
        show_frame()
        if differing := differences(before, digest()):
            raise LeftWrongError(f"not the same after everything was read anew: {differing}")
        if wrong := followed_places.misplaced():
            raise LeftWrongError(f"elsewhere: {wrong}")


def take_up_edits() -> None:
    """Edited points stay where they are put. When they are posed again, they move by rounding
    errors, which is no reason to end.
    """
    bpy.context.view_layer.update()
    show_frame()


def show_frame() -> None:
    """Has Blender evaluate animation. After undo, shapes may be those of another frame until this
    is done.
    """
    scene = bpy.context.scene
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


def _visible(kind: str) -> list[bpy.types.Object]:
    return [ob for ob in bpy.context.view_layer.objects if ob.type == kind and ob.visible_get()]


def _surfaces() -> list[bpy.types.Object]:
    return [ob for ob in _visible("MESH") if ob.data.polygons]


def _things() -> list[bpy.types.Object]:
    """Returns what has places on surfaces."""
    found = [*_visible("CURVES"), *_visible("MESH"), *_visible("CURVE")]
    return [ob for ob in found if followers.is_placed(ob)]


def _can_join(a: bpy.types.Object, b: bpy.types.Object) -> bool:
    return followers.surface_of(a) == followers.surface_of(b) and a.matrix_world == b.matrix_world


if __name__ == "__main__":
    random_steps.end(Following)
