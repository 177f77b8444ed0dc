# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats in which an object is written.

Alembic and USD come from Blender's own exporters, which evaluate the object as for a render. They
write several objects in an order that changes from run to run; with one object in each file, the
same frame gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..errors import RefusalError
from ..placing import live_kept
from ..reading import private_scene
from . import alembic_file, arrays, usd_file

#: Of a matrix, as a share of its largest number. Rounding in Blender loses 5e-5 where an axis is a
#: thousand times shorter than the others.
_LARGEST_LOSS = 1e-4

#: The longest chain of surfaces each of which follows another one live
_LONGEST_CHAIN = 16


@dataclass(frozen=True)
class Subject:
    """An object, and a collection that holds nothing else: exporters of a collection evaluate only
    what its objects need, and write also what is hidden in the viewport.
    """

    ob: bpy.types.Object
    collection: bpy.types.Collection


@dataclass(frozen=True)
class Format:
    name: str
    suffix: str
    write: Callable[[Path, Subject], bool]  # tells whether the object shows anything
    build_option: str  # what Blender must have been built with
    as_rendered: bool  # whether settings for renders count, and not those of the viewport
    types: frozenset[str] = frozenset()  # the types of objects that it can hold; empty: all

    def check(self) -> None:
        """Raises RefusalError where this Blender cannot write the format."""
        if self.build_option and not getattr(build_options(), self.build_option):
            raise RefusalError(
                f"this Blender was built without {self.name}: use another one, or --format npz"
            )


def build_options() -> Any:
    return bpy.app.build_options


def _write_alembic(path: Path, subject: Subject) -> bool:
    _check_scale(subject.ob)
    _check_shear(subject.ob)
    shows = _export(
        subject.ob,
        bpy.ops.wm.alembic_export,
        filepath=str(path),
        collection=subject.collection.name,
        # A range of one frame is written as the scene is now, whichever frame that is.
        start=1,
        end=1,
        init_scene_frame_range=False,
        as_background_job=False,
        evaluation_mode="RENDER",
    )
    alembic_file.normalize(path)
    return shows


def _write_usd(path: Path, subject: Subject) -> bool:
    _check_scale(subject.ob)
    shows = _export(
        subject.ob,
        bpy.ops.wm.usd_export,
        filepath=str(path),
        collection=subject.collection.name,
        visible_objects_only=False,  # those hidden in the viewport too
        export_animation=False,
        export_hair=True,
        # Textures and volumes would be files of their own.
        export_materials=False,
        export_textures=False,
        export_volumes=False,
        convert_world_material=False,
        xform_op_mode="MAT",  # location, rotation and scale cannot hold shear
        evaluation_mode="RENDER",
    )
    usd_file.check_complete(path)
    return shows


def _check_scale(ob: bpy.types.Object) -> None:
    """Raises RefusalError where the object or one of its parents is flat: the exporters then write
    a transform of zeros.
    """
    flat = ""
    found: bpy.types.Object | None = ob
    while found:
        if not all(found.matrix_world.to_scale()):
            flat = found.name  # the last one has made the others flat
        found = found.parent
    if flat:
        raise RefusalError(
            f"{flat} has a scale of 0 along an axis, which Blender's exporters do not write: use "
            "--format npz"
        )


def _check_shear(ob: bpy.types.Object) -> None:
    """Raises RefusalError where the transform of the object or of one of its parents, relative to
    its own parent, is sheared: the exporter writes location, rotation and scale.
    """
    found: bpy.types.Object | None = ob
    while found:
        world = found.matrix_world
        parent = found.parent.matrix_world if found.parent else Matrix()
        own = parent.inverted_safe() @ world
        written = parent @ Matrix.LocRotScale(*own.decompose())
        lost = np.abs(np.array(world.to_3x3()) - written.to_3x3()).max()
        if lost > _LARGEST_LOSS * np.abs(world.to_3x3()).max():
            raise RefusalError(
                f"{found.name} is sheared by its own transform, which Blender's Alembic exporter "
                "does not write: use --format usd or npz"
            )
        found = found.parent


@contextmanager
def _watched(ob: bpy.types.Object) -> Iterator[list[bool]]:
    """Yields a list to which each evaluation of an exporter adds whether the object shows anything:
    points or instances.
    """
    shows: list[bool] = []

    def look(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        evaluated = ob.evaluated_get(depsgraph)
        if depsgraph.mode == "RENDER" and evaluated.is_evaluated and ob.type in arrays.TYPES:
            shows.append(not arrays.is_empty(evaluated) or _has_instances(ob, depsgraph))

    handlers = bpy.app.handlers.depsgraph_update_post
    handlers.append(look)
    try:
        yield shows
    finally:
        handlers.remove(look)


def _has_instances(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    return any(
        each.is_instance and each.parent and each.parent.original == ob
        for each in depsgraph.object_instances
    )


def _export(ob: bpy.types.Object, operator: Callable[..., set[str]], **properties: object) -> bool:
    """Writes the file, in which all is posed as renders show it, and tells whether the object shows
    anything there. While an exporter is at work, the handlers of live following cannot evaluate
    surfaces on their own. A surface that has changed because another one was posed is right when
    the exporter evaluates it again.
    """
    # Versions of Blender differ in what can be chosen.
    known = operator.get_rna_type().properties.keys()  # type: ignore[attr-defined]
    properties = {key: value for key, value in properties.items() if key in known}
    for _ in range(_LONGEST_CHAIN):
        before = live_kept.moves()
        with private_scene.barred() as bar, _watched(ob) as shows:
            if operator(**properties) != {"FINISHED"}:
                raise RefusalError("Blender's exporter has written nothing")
        if not bar.attempts:
            return all(shows[-1:])
        if live_kept.moves() == before:
            break
    raise RefusalError(
        f"{ob.name} cannot be posed as renders show it, because the surface that it follows has no "
        f"modifier {ids.CAPTURE_GROUP}: object.limit_follow adds the modifier, or use --format npz"
    )


FORMATS = {
    "abc": Format("Alembic", ".abc", _write_alembic, "alembic", True),
    "usd": Format("USD", ".usd", _write_usd, "usd", True),
    "usda": Format("USD", ".usda", _write_usd, "usd", True),
    "npz": Format(
        "numpy",
        ".npz",
        lambda path, subject: arrays.write(path, subject.ob),
        "",
        False,
        arrays.TYPES,
    ),
}
