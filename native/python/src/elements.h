// SPDX-License-Identifier: Apache-2.0
//
// What numpy would silently make something else of, when it reads lists element by element.
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// Whether numpy reads an object as an array as it is, without looking at its elements.
bool isReadAsArray(const pybind11::handle& object);

/// What is to become of True and False.
enum class Booleans { allowed, refused };

/// Throws TypeError, naming the element and its value, if an object is a masked array, or a list
/// (or another sequence, at any depth) that holds one: the mask would be lost. `expected` is what
/// the argument should be; with Booleans::refused nothing in the object may be True or False
/// either, which would become 1 and 0. Elements of arrays are not looked at. A list of a million
/// numbers takes some milliseconds.
void refuseLostElements(const pybind11::handle& object, const char* name, Booleans booleans,
                        const char* expected);

}  // namespace limitsurf::python
