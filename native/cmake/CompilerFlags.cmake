# SPDX-License-Identifier: Apache-2.0
#
# The compiler's options for the project's own sources. LIMITSURF_FLAGS are the warnings. A warning
# ends the build (CMAKE_COMPILE_WARNING_AS_ERROR), unless another project includes this one.
# LIMITSURF_EXACT_FLAGS forbid fused multiply-adds, which would make a location's bits depend on the
# machine.
if(NOT DEFINED CMAKE_COMPILE_WARNING_AS_ERROR)
  set(CMAKE_COMPILE_WARNING_AS_ERROR ${PROJECT_IS_TOP_LEVEL})
endif()

if(MSVC)
  set(LIMITSURF_FLAGS /W3 /bigobj /utf-8)
  set(LIMITSURF_EXACT_FLAGS /fp:precise)
else()
  set(LIMITSURF_FLAGS -Wall -Wextra -Wshadow)
  set(LIMITSURF_EXACT_FLAGS -ffp-contract=off)
endif()
