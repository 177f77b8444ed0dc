# SPDX-License-Identifier: Apache-2.0
#
# Compiles through ccache where that is installed, and with precompiled headers elsewhere. Not with
# both: a precompiled header differs from build to build, so that what was compiled with one would
# never be found in the cache again.
find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM} CACHE STRING "Runs the compiler")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
