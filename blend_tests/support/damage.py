# SPDX-License-Identifier: GPL-3.0-or-later
"""What happens to objects and their data in files from elsewhere: scales of 0, numbers that are not
finite, data without anything in it, attributes of other types, things that are hidden or linked.
"""

from __future__ import annotations

from collections.abc import Iterator

import damage_data
import damage_objects
from damage_kinds import INF, NAN, Damage

OF_OBJECTS: dict[str, Damage] = {
    "scale 0": damage_objects.placed("scale", (0, 0, 0)),
    "flat": damage_objects.placed("scale", (1, 0, 1)),
    "mirrored": damage_objects.placed("scale", (-1, 2, 0.5)),
    "scale NaN": damage_objects.placed("scale", (NAN, 1, 1)),
    "scale inf": damage_objects.placed("scale", (INF, 1, 1)),
    "scale 1e30": damage_objects.placed("scale", (1e30, 1e30, 1e30)),
    "scale 1e-30": damage_objects.placed("scale", (1e-30, 1e-30, 1e-30)),
    "scales 1e30 and 1e-30": damage_objects.placed("scale", (1e30, 1e-30, 1)),
    "at NaN": damage_objects.placed("location", (0, NAN, 0)),
    "at inf": damage_objects.placed("location", (INF, 0, 0)),
    "at 1e30": damage_objects.placed("location", (1e30, 0, 0)),
    "at 3e38": damage_objects.placed("location", (3e38, 3e38, -3e38)),
    "turned by NaN": damage_objects.placed("rotation_euler", (NAN, 0, 0)),
    "parent of scale 0": damage_objects.parent_of_scale_0,
    "keyframed": damage_objects.keyframed,
    "driven to NaN": damage_objects.driven_to_nan,
    "nothing in it": damage_data.nothing_in_it,
    "vertices alone": damage_data.vertices_alone,
    "one point": damage_data.one_point,
    "NURBS": damage_data.nurbs,
    "loose edge": damage_data.loose_edge,
    "a point at NaN": damage_data.one_at(NAN),
    "a point at inf": damage_data.one_at(INF),
    "a point at 1e30": damage_data.one_at(1e30),
    "a point at 3e38": damage_data.one_at(3e38),
    "all points at one": damage_data.positions(lambda at: 0 * at + 1),
    "all points at 1e30": damage_data.positions(lambda at: 0 * at + 1e30),
    "all points tiny": damage_data.positions(lambda at: 1e-38 * at),
    "all points huge": damage_data.positions(lambda at: 5e37 * at),
    "no map": damage_data.no_map,
    "map NaN": damage_data.map_at(NAN),
    "map in a point": damage_data.map_at(0.5),
    "map at 1e9": damage_data.map_at(1e9),
    "attributes NaN": damage_data.on_attributes(damage_data.not_numbers),
    "attributes out of range": damage_data.on_attributes(damage_data.out_of_range),
    "attributes negative": damage_data.on_attributes(damage_data.negative),
    "attributes of another type": damage_data.on_attributes(damage_data.of_another_type),
    "attributes on another domain": damage_data.on_attributes(damage_data.on_another_domain),
    "attributes removed": damage_data.on_attributes(damage_data.attribute_removed),
    "names taken": damage_data.names_taken,
    "groups with taken names": damage_data.groups_with_taken_names,
    "creases NaN": damage_data.creased(NAN),
    "creases -1": damage_data.creased(-1),
    "creases 1e30": damage_data.creased(1e30),
    "shape keys at NaN": damage_data.shape_keys,
    "shared data": damage_objects.shared_data,
    "mirror before": damage_objects.modifier_before("MIRROR"),
    "array before": damage_objects.modifier_before("ARRAY", count=0, use_relative_offset=False),
    "mask before": damage_objects.modifier_before("MASK", vertex_group="Group", threshold=1.0),
    "multires": damage_objects.modifier_before("MULTIRES"),
    "cloth before": damage_objects.modifier_before("CLOTH"),
    "build before": damage_objects.modifier_before("BUILD", frame_start=100),
    "wireframe before": damage_objects.modifier_before("WIREFRAME"),
    "boolean before": damage_objects.modifier_before("BOOLEAN"),
    "nothing by nodes": damage_objects.nothing_by_nodes,
    "no modifiers": damage_objects.no_modifiers,
    "modifiers disabled": damage_objects.modifiers_disabled,
    "hidden": damage_objects.hidden,
    "disabled": damage_objects.disabled,
    "in no collection": damage_objects.in_no_collection,
    "in an excluded collection": damage_objects.in_an_excluded_collection,
    "removed": damage_objects.removed,
    "data removed": damage_objects.data_removed,
    "edit mode": damage_objects.mode("EDIT"),
    "sculpt mode": damage_objects.mode("SCULPT"),
    "linked": damage_objects.linked,
    "overridden": damage_objects.linked_and_overridden,
}

OF_FILES: dict[str, Damage] = {
    "groups removed": damage_objects.groups_removed,
    "groups emptied": damage_objects.groups_emptied,
    "tables removed": damage_objects.tables_removed,
    "tables emptied": damage_objects.tables_emptied,
    "strings for properties": damage_objects.strings_for_properties,
    "nothing active": damage_objects.nothing_active,
    "nothing selected": damage_objects.nothing_selected,
    "everything selected": damage_objects.everything_selected,
    "picture without pixels": damage_objects.picture_without_pixels,
    "picture not finite": damage_objects.picture_not_finite,
    "picture of a movie": damage_objects.picture_movie,
    "picture tiled": damage_objects.picture_tiled,
    "picture removed": damage_objects.picture_removed,
}


def all_cases() -> Iterator[tuple[str, str, Damage]]:
    """Yields what is damaged, how, and the damage."""
    for name, damage in OF_OBJECTS.items():
        yield "surface", name, damage
        yield "thing", name, damage
    for name, damage in OF_FILES.items():
        yield "file", name, damage
