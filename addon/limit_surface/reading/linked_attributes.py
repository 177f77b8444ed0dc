# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of linked data, for as long as the file is open.

Blender's Python writes single values of linked data, but its function for whole arrays leaves them
as they are, without an error. So the values are copied to where Blender holds them.
"""

import ctypes

import bpy
import numpy as np

from ..errors import RefusalError
from .attributes import LAYOUTS


def write(data: bpy.types.ID, name: str, values: np.ndarray) -> None:
    """Overwrites an attribute with one row of `values` for each element. Raises RefusalError where
    Blender does not hold the values one after the other.
    """
    attribute = data.attributes[name]
    layout = LAYOUTS[attribute.data_type]
    values = np.ascontiguousarray(values, layout.dtype)
    elements, count = attribute.data, len(attribute.data)
    if values.size != count * layout.width:
        raise ValueError(f"{name}: {values.shape} values for {count} elements")
    if not count:
        return
    # Looking an element up makes sure that no copy of the data shares the memory.
    first, last = elements[0].as_pointer(), elements[count - 1].as_pointer()
    width = layout.width * values.itemsize
    held: np.ndarray = np.frombuffer(ctypes.string_at(first, width), layout.dtype)
    shown: np.ndarray = np.ravel(np.array(getattr(elements[0], layout.key), layout.dtype))
    if last - first != (count - 1) * width or not np.array_equal(held, shown, equal_nan=True):
        raise RefusalError(f"{data.name} is linked, and its attribute {name} cannot be written")
    ctypes.memmove(first, values.ctypes.data, values.nbytes)
