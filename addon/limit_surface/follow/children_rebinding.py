# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes live children again with the settings that they were made with."""

import bpy

from .. import ids
from ..errors import RefusalError
from ..placing import followers, following, live_children


def make_again(context: bpy.types.Context, ob: bpy.types.Object) -> str:
    """Makes the table of live children again, on the surface and from the guides as they are now,
    and returns a report. Raises RefusalError where that is impossible; they are those of before
    then.
    """
    following.check_editable(ob)
    guides, settings = live_children.guides_of(ob), live_children.settings_of(ob)
    if guides is None or guides.type != "CURVES":
        raise RefusalError(
            f"The guides of {ob.name} were deleted: choose other guides in its modifier "
            f"{ids.CHILDREN_GROUP}"
        )
    if followers.ground_of(guides) is None:
        raise RefusalError(
            f"{ob.name} could not be made again: its guides, {guides.name}, stand on no mesh any "
            "more"
        )
    # the operator belongs to another capability, which this one does not import
    operator = bpy.ops.object.limit_children_add
    known = operator.get_rna_type().properties
    arguments = {
        name: set(value) if _is_flag(known[name]) else value
        for name, value in settings.items()
        if name in known
    }
    try:
        with context.temp_override(active_object=guides, object=guides):
            operator(
                "EXEC_DEFAULT",
                **arguments | {"guides": guides.name, "replaces": ob.name, "allow_large": True},
            )
    except RuntimeError as error:
        reason = str(error).removeprefix("Error: ").strip()
        raise RefusalError(f"{ob.name} could not be made again: {reason}") from error
    return f"{live_children.count_of(ob):,} live children of {ob.name} were made again"


def _is_flag(prop: bpy.types.Property) -> bool:
    return prop.type == "ENUM" and prop.is_enum_flag
