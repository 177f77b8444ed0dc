# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist may do to a file, in random order: the extension's operators with random
properties, undo and redo, saving and loading, modes, deletions, new names, edits of meshes, and
objects that are linked from another file.

    python random_steps.py SEED STEPS FOLDER

Prints each step, and ends with an error at the first one that raises anything but a refusal, that
leaves something behind, or that undo and redo do not restore. FOLDER is where files are saved.
"""

import faulthandler
import os
import random
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

SUPPORT = Path(__file__).resolve().parent
ROOT = SUPPORT.parents[1]
sys.path[:0] = [str(SUPPORT), str(ROOT / "addon"), str(ROOT / "docs")]

import bpy  # noqa: E402  # isort: skip
import bmesh  # noqa: E402
import limit_surface  # noqa: E402
import scenes  # noqa: E402
from contents import digest  # noqa: E402
from limit_surface import ids  # noqa: E402

#: Operators that need no window. What they make must stay small: these limit random properties.
OPERATORS = (
    *(ids.HAIR_ADD, ids.POINTS_ADD, ids.CHILDREN_ADD, ids.SNAP, ids.CURVE_LAY, ids.SHOW),
    *(ids.REPORT_OPERATOR, ids.CURVATURE, ids.LIMIT_MESH, ids.BAKE_MAPS, ids.PROJECT_IMAGE),
    *(ids.BAKE_DISPLACEMENT, ids.FOLLOW, ids.UNBIND, ids.REBIND, ids.ATTACH),
    *(ids.PARTICLES_FROM_HAIR, ids.HAIR_FROM_PARTICLES, ids.SAMPLE_TABLES, ids.SAMPLE_REMOVE),
)
#: Operators that take hair or other curves, and those of them that need nothing else selected
ON_HAIR = {ids.CHILDREN_ADD, ids.SNAP, ids.CURVE_LAY, ids.FOLLOW, ids.UNBIND, ids.REBIND,
           ids.ATTACH, ids.PARTICLES_FROM_HAIR}  # fmt: skip
ALONE = {ids.CHILDREN_ADD, ids.UNBIND, ids.REBIND, ids.PARTICLES_FROM_HAIR}
SMALL = {"per_side": 4, "width": 32, "height": 32, "count": 60, "points": 4, "decal_resolution": 4}
LIMITS = {"per_side": 8, "count": 200, "points": 9, "levels": 3, "most_levels": 3, "level": 3,
          "guide_count": 8, "rows": 3, "keys": 8, "depth": 16, "margin": 8}  # fmt: skip
#: Properties that keep their value: sizes of pictures, and permissions to exceed the limits
KEPT = {"width", "height", "allow_large", "decal_resolution", "face_resolution", "density",
        "distance", "folder", "filepath", "rna_type", "replaces", "view_matrix"}  # fmt: skip
MESHES = (scenes.cross, scenes.grid_with_holes, scenes.mixed_polygons)
MOST_OBJECTS, MOST_VERTICES = 25, 5000
#: What Blender itself keeps in a file without objects
FRAME = {"brushes", "libraries", "palettes", "scenes", "screens", "window_managers", "workspaces",
         "worlds"}  # fmt: skip


class LeftWrongError(Exception):
    """A step has left something wrong."""


class Session:
    def __init__(self, seed: int, folder: Path) -> None:
        self.random = random.Random(seed)
        self.folder = folder
        self.handlers = handler_counts()
        self.threads = threading.active_count()
        self.libraries: list[Path] = []
        self.steps: list[tuple[int, Callable[[], str]]] = [
            (10, self.add_mesh),
            (60, self.run_operator),
            (12, self.activate),
            (8, self.undo_or_redo),
            (3, self.save_and_load),
            (4, self.change_mode),
            (4, self.delete),
            (3, self.rename),
            (4, self.duplicate),
            (5, self.edit_mesh),
            (4, self.change_modifiers),
            (3, self.change_frame),
            (4, self.add_something),
            (2, self.save_library),
            (3, self.link),
        ]

    def run_all(self, steps: int) -> None:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        push("begin")
        self.add_mesh()
        for i in range(steps):
            weights = [weight for weight, _ in self.steps]
            (step,) = self.random.choices([each for _, each in self.steps], weights)
            print(f"{i} {step.__name__}", end=" ", flush=True)
            print(step(), flush=True)
            self.check()
            self.remove_large()
        self.check_end()

    # What an artist does

    def add_mesh(self) -> str:
        if len(bpy.data.objects) > MOST_OBJECTS:
            return self.delete(half=True)
        if not enter_object_mode():
            return "not in this mode"
        bpy.ops.object.select_all(action="DESELECT")
        ob = self.random.choice(MESHES)()
        if self.random.random() < 0.6:
            ob.modifiers.new("Subdivision", "SUBSURF").levels = self.random.randint(0, 3)
        if self.random.random() < 0.6:
            ob.data.uv_layers.new(name="UVMap")
        push("mesh")
        return ob.name

    def run_operator(self) -> str:
        name = self.random.choice(OPERATORS)
        if self.random.random() < 0.7 and enter_object_mode():
            self.select_for(name)
        area, _, verb = name.partition(".")
        operator = getattr(getattr(bpy.ops, area), verb)
        properties = self.properties(operator.get_rna_type())
        before, names = digest(), scenes.file_contents()
        try:
            result = operator("EXEC_DEFAULT", True, **properties)
        except RuntimeError as error:
            if "Traceback" in str(error):
                raise
            differing = differences(before, digest()) or differences(names, scenes.file_contents())
            if differing:
                what = f"{name} {properties} was refused, but changed {differing}"
                raise LeftWrongError(what) from error
            return f"{verb} {properties}: refused"
        if result != {"FINISHED"}:
            raise LeftWrongError(f"{name} {properties} returned {result}")
        if bpy.context.mode == "OBJECT" and "UNDO" in operator.bl_options:
            self.check_undo(f"{name} {properties}", before)
        return f"{verb} {properties}"

    def select_for(self, operator: str) -> None:
        """Selects objects that the operator takes, where there are any."""
        objects = list(bpy.context.view_layer.objects)
        meshes = [ob for ob in objects if ob.type == "MESH"]
        hair = [ob for ob in objects if ob.type in ("CURVES", "CURVE")]
        chosen: list[bpy.types.Object] = []
        if hair and operator in ON_HAIR:
            chosen.append(self.random.choice(hair))
        parents = [ob.data.surface for ob in chosen if ob.type == "CURVES" and ob.data.surface]
        if operator not in ALONE and (parents or meshes):
            chosen.append(self.random.choice(parents or meshes))
        if not chosen:
            return
        bpy.ops.object.select_all(action="DESELECT")
        for ob in chosen:
            if ob in objects:
                ob.select_set(True)
                bpy.context.view_layer.objects.active = ob
        push("selection")

    def remove_large(self) -> None:
        """Meshes on the surfaces of other meshes would soon have millions of vertices."""
        large = [mesh for mesh in bpy.data.meshes if len(mesh.vertices) > MOST_VERTICES]
        if large and enter_object_mode():
            bpy.data.batch_remove(large)
            push("large meshes removed")

    def activate(self) -> str:
        if not bpy.context.view_layer.objects or not enter_object_mode():
            return "nothing to activate"
        bpy.ops.object.select_all(action="DESELECT")
        objects = list(bpy.context.view_layer.objects)
        for ob in self.random.sample(objects, min(len(objects), self.random.choice((1, 1, 2, 3)))):
            ob.select_set(True)
            bpy.context.view_layer.objects.active = ob
        push("selection")
        return ", ".join(ob.name for ob in bpy.context.selected_objects)

    def undo_or_redo(self) -> str:
        count, operator = self.random.randint(1, 4), bpy.ops.ed.undo
        if self.random.random() < 0.4:
            operator = bpy.ops.ed.redo
        done = 0
        while done < count and operator.poll():
            try:
                operator()
            except RuntimeError:  # there is no such step
                break
            done += 1
        return f"{operator.idname_py()} {done} times"

    def save_and_load(self) -> str:
        if not enter_object_mode():
            return "not in this mode"
        file = self.folder / "session.blend"
        bpy.context.preferences.filepaths.save_version = 0
        bpy.data.orphans_purge(do_recursive=True)  # a file does not save what only orphans use
        bpy.ops.wm.save_as_mainfile(filepath=str(file), check_existing=False)
        before = digest(saved_only=True)
        bpy.ops.wm.open_mainfile(filepath=str(file))
        differing = differences(before, digest(saved_only=True))
        if differing:
            raise LeftWrongError(f"not as they were saved: {differing}")
        push("load")
        return file.name

    def change_mode(self) -> str:
        ob = bpy.context.view_layer.objects.active
        if ob is None:
            return "nothing is active"
        modes = {"MESH": ("EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT"),
                 "CURVES": ("EDIT", "SCULPT_CURVES"), "CURVE": ("EDIT",)}  # fmt: skip
        mode = self.random.choice((*modes.get(ob.type, ()), "OBJECT"))
        if ob.mode == mode:
            return mode
        try:
            bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode=mode)
        except RuntimeError:  # linked, hidden, or not without a window
            return f"{mode} is not possible"
        return f"{ob.name} {mode}"

    def delete(self, half: bool = False) -> str:
        objects = list(bpy.data.objects)
        if not objects or not enter_object_mode():
            return "nothing to delete"
        doomed = self.random.sample(objects, len(objects) // 2 if half else 1)
        names = [ob.name for ob in doomed]
        for ob in doomed:
            data = ob.data
            bpy.data.objects.remove(ob)
            if data and not data.users and self.random.random() < 0.5:
                bpy.data.batch_remove([data])
        push("delete")
        return ", ".join(names)

    def rename(self) -> str:
        blocks = [*bpy.data.objects, *bpy.data.meshes, *bpy.data.hair_curves, *bpy.data.node_groups,
                  *bpy.data.images]  # fmt: skip
        blocks = [block for block in blocks if block.library is None]
        if not blocks:
            return "nothing to rename"
        block = self.random.choice(blocks)
        before, block.name = block.name, self.random.choice(("Näme", "x" * 63, "Cross", "a.001"))
        push("rename")
        return f"{before} -> {block.name}"

    def duplicate(self) -> str:
        if not bpy.context.selected_objects or not enter_object_mode():
            return "nothing is selected"
        if len(bpy.data.objects) > MOST_OBJECTS:
            return self.delete(half=True)
        bpy.ops.object.duplicate("EXEC_DEFAULT", True, linked=self.random.random() < 0.5)
        copies = bpy.context.selected_objects
        # Blender does not save what was linked only as the parent of a linked object
        parents = [ob.parent for ob in copies if ob.parent and ob.parent.users == 0]
        for parent in dict.fromkeys(parents):
            bpy.context.scene.collection.objects.link(parent)
        push("duplicate")
        return ", ".join(ob.name for ob in copies)

    def add_something(self) -> str:
        """What operators take besides meshes: images, a camera, curves."""
        if not enter_object_mode() or len(bpy.data.objects) > MOST_OBJECTS:
            return "not in this mode"
        kind = self.random.choice(("image", "camera", "curve", "empty"))
        if kind == "image":
            made = bpy.data.images.new("Picture", 16, 8, float_buffer=self.random.random() < 0.5)
            made.pixels.foreach_set([self.random.random() for _ in range(16 * 8 * 4)])
        else:
            add = {
                "camera": bpy.ops.object.camera_add,
                "curve": bpy.ops.curve.primitive_bezier_curve_add,
                "empty": bpy.ops.object.empty_add,
            }[kind]
            add("EXEC_DEFAULT", True, location=(0, 0, 2))
            made = bpy.context.object
            if kind == "camera":
                bpy.context.scene.camera = made
        push(kind)
        return made.name

    def edit_mesh(self) -> str:
        meshes = [mesh for mesh in bpy.data.meshes if mesh.library is None and mesh.polygons]
        if not meshes or not enter_object_mode():
            return "no mesh"
        mesh = self.random.choice(meshes)
        edited = bmesh.new()
        edited.from_mesh(mesh)
        faces = list(edited.faces)
        kind = self.random.choice(("move", "delete", "crease", "empty", "split"))
        if kind == "move":
            for vertex in edited.verts:
                vertex.co *= self.random.uniform(0.8, 1.2)
        elif kind == "delete":
            doomed = self.random.sample(faces, max(1, len(faces) // 8))
            bmesh.ops.delete(edited, geom=doomed, context="FACES")
        elif kind == "crease":
            layer = edited.edges.layers.float.get("crease_edge")
            layer = layer or edited.edges.layers.float.new("crease_edge")
            for edge in self.random.sample(list(edited.edges), len(edited.edges) // 4):
                edge[layer] = self.random.random()
        elif kind == "split" and len(faces) < 200:
            bmesh.ops.poke(edited, faces=self.random.sample(faces, max(1, len(faces) // 4)))
        elif kind == "empty" and self.random.random() < 0.1:
            edited.clear()
        edited.to_mesh(mesh)
        edited.free()
        push("edit")
        return f"{mesh.name} {kind}"

    def change_modifiers(self) -> str:
        objects = [ob for ob in bpy.data.objects if ob.type in ("MESH", "CURVES")]
        objects = [ob for ob in objects if ob.library is None]
        if not objects or not enter_object_mode():
            return "no object"
        ob = self.random.choice(objects)
        if ob.modifiers and self.random.random() < 0.5:
            modifier = self.random.choice(list(ob.modifiers))
            name = modifier.name
            if self.random.random() < 0.5:
                ob.modifiers.remove(modifier)
            else:
                modifier.show_viewport = not modifier.show_viewport
        else:
            kinds = ["NODES"]
            if ob.type == "MESH":
                # several of a kind would soon make millions of polygons
                there = {modifier.type for modifier in ob.modifiers}
                kinds = [each for each in ("SUBSURF", "MIRROR", "ARRAY") if each not in there]
            if not kinds:
                return "enough modifiers"
            name = ob.modifiers.new("Added", self.random.choice(kinds)).name
        push("modifiers")
        return f"{ob.name} {name}"

    def change_frame(self) -> str:
        frame = self.random.randint(0, 20)
        bpy.context.scene.frame_set(frame)
        return str(frame)

    def save_library(self) -> str:
        file = self.folder / f"library{len(self.libraries)}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(file), copy=True, check_existing=False)
        self.libraries.append(file)
        return file.name

    def link(self) -> str:
        if not self.libraries or not enter_object_mode() or len(bpy.data.objects) > MOST_OBJECTS:
            return "nothing to link"
        file = self.random.choice(self.libraries)
        with bpy.data.libraries.load(str(file), link=True) as (inside, linked):
            names = list(inside.objects)
            linked.objects = self.random.sample(names, min(2, len(names)))
        for ob in linked.objects:
            if ob is not None and ob.name not in bpy.context.collection.objects:
                bpy.context.collection.objects.link(ob)
        push("link")
        return ", ".join(ob.name for ob in linked.objects if ob)

    # Properties of operators

    def properties(self, operator: bpy.types.Struct) -> dict[str, object]:
        given = {p.identifier for p in operator.properties}
        values: dict[str, object] = {name: SMALL[name] for name in SMALL if name in given}
        free = [p for p in operator.properties if p.identifier not in KEPT and not p.is_readonly]
        free = [p for p in free if p.type != "ENUM" or p.enum_items_static]
        for chosen in self.random.sample(free, min(len(free), self.random.randint(0, 4))):
            values[chosen.identifier] = self.value(chosen)
        return values

    def value(self, chosen: bpy.types.Property) -> object:
        if chosen.type == "BOOLEAN":
            value = self.random.random() < 0.5
            return [value] * chosen.array_length if chosen.array_length else value
        if chosen.type == "ENUM":
            items = [item.identifier for item in chosen.enum_items_static]
            if chosen.is_enum_flag:
                return set(self.random.sample(items, self.random.randint(0, len(items))))
            return self.random.choice(items)
        if chosen.type == "INT":
            most = LIMITS.get(chosen.identifier, 1000)
            return self.random.randint(chosen.hard_min, min(chosen.hard_max, most))
        if chosen.type == "FLOAT":
            low, high = max(chosen.hard_min, -10.0), min(chosen.hard_max, 10.0)
            value = self.random.choice((low, high, self.random.uniform(low, high)))
            return [value] * chosen.array_length if chosen.array_length else value
        images = "image" in chosen.identifier or chosen.identifier == "target"
        blocks = bpy.data.images if images else bpy.data.objects
        names = [block.name for block in blocks]
        return self.random.choice([*names, "UVMap", "crease_edge", "no such name", ""])

    # What must hold

    def check_undo(self, step: str, before: dict[str, object]) -> None:
        after = digest()
        bpy.ops.ed.undo()
        self.evaluate_animation()
        differing = differences(before, digest())
        if differing:
            raise LeftWrongError(f"undo of {step} does not restore {differing}")
        bpy.ops.ed.redo()
        self.evaluate_animation()
        differing = differences(after, digest())
        if differing:
            raise LeftWrongError(f"redo of {step} does not restore {differing}")

    def evaluate_animation(self) -> None:
        """Is called after undo and redo. These files have no animation."""

    def check(self) -> None:
        if len(bpy.data.scenes) != 1:
            raise LeftWrongError(f"scenes: {[scene.name for scene in bpy.data.scenes]}")
        if handler_counts() != self.handlers:
            raise LeftWrongError(f"handlers: {handler_counts()}, {self.handlers} before")
        if threading.active_count() != self.threads:
            raise LeftWrongError(f"threads: {threading.enumerate()}")

    def check_end(self) -> None:
        """After everything has been deleted, nothing is left in the file."""
        enter_object_mode()
        bpy.data.batch_remove(list(bpy.data.objects))
        bpy.data.batch_remove([*bpy.data.images])  # baked ones are kept for the artist
        bpy.data.orphans_purge(do_recursive=True)
        left = {kind: names for kind, names in scenes.file_contents().items() if names}
        left = {kind: names for kind, names in left.items() if kind not in FRAME}
        if left:
            raise LeftWrongError(f"left in the file: {left}")


def push(message: str) -> None:
    bpy.ops.ed.undo_push(message=message)


def enter_object_mode() -> bool:
    if bpy.context.mode != "OBJECT":
        try:
            bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="OBJECT")
        except RuntimeError:  # nothing is active
            return False
    return True


def handler_counts() -> dict[str, int]:
    handlers = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return {name: len(each) for name, each in handlers.items() if isinstance(each, list)}


def differences(before: dict[str, object], after: dict[str, object]) -> list[str]:
    return [key for key in {**before, **after} if before.get(key) != after.get(key)]


def end(session: type[Session]) -> NoReturn:
    """Runs the session that the command line describes, and ends the process."""
    code = 1
    try:
        seed, steps, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
        faulthandler.enable()
        limit_surface.register()
        session(seed, folder).run_all(steps)
        print("all steps done", flush=True)
        code = 0
    except BaseException:
        sys.excepthook(*sys.exc_info())
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # the module's own clean-up at exit sometimes hangs


if __name__ == "__main__":
    end(Session)
