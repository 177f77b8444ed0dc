# SPDX-License-Identifier: Apache-2.0
#
# Clang, libc++ and the system's headers from the package ziglang of PyPI, for systems other than the
# one that compiles: LIMITSURF_ZIG_TARGET is x86_64-linux-gnu.2.28 (a Linux with that glibc or a later
# one), aarch64-macos or x86_64-windows-gnu. The program `zig` is looked for on PATH and in the Python
# environment on PATH. It needs LIMITSURF_BUNDLED_DEPENDENCIES, and for tests
# LIMITSURF_BUNDLED_TEST_LIBRARIES; for another system also a folder in CMAKE_PREFIX_PATH with the
# headers and the CMake packages of Eigen and Boost.
set(LIMITSURF_ZIG_TARGET "" CACHE STRING "System and C library to compile for, as Zig names them")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LIMITSURF_ZIG_TARGET LIMITSURF_ZIG)
if(NOT LIMITSURF_ZIG_TARGET MATCHES "^([^-]+)-(linux|macos|windows)")
  message(FATAL_ERROR "LIMITSURF_ZIG_TARGET is \"${LIMITSURF_ZIG_TARGET}\"; "
    "expected a target such as x86_64-linux-gnu.2.28")
endif()
set(limitsurf_zig_processor ${CMAKE_MATCH_1})
set(limitsurf_zig_system ${CMAKE_MATCH_2})

find_program(LIMITSURF_ZIG zig)
if(NOT LIMITSURF_ZIG)
  execute_process(
    COMMAND python -c "import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).parent / 'zig')"
    OUTPUT_VARIABLE limitsurf_zig OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  set(LIMITSURF_ZIG "${limitsurf_zig}" CACHE FILEPATH "The program zig" FORCE)
endif()
if(NOT LIMITSURF_ZIG)
  message(FATAL_ERROR "There is no program zig: pip install ziglang brings it")
endif()

# A build for this machine's own kind of system is no cross build: its programs run here.
set(limitsurf_zig_names_linux Linux)
set(limitsurf_zig_names_macos Darwin)
set(limitsurf_zig_names_windows Windows)
set(limitsurf_zig_name ${limitsurf_zig_names_${limitsurf_zig_system}})
if(NOT limitsurf_zig_name STREQUAL CMAKE_HOST_SYSTEM_NAME
    OR NOT limitsurf_zig_processor STREQUAL CMAKE_HOST_SYSTEM_PROCESSOR)
  set(CMAKE_SYSTEM_NAME ${limitsurf_zig_name})
  set(CMAKE_SYSTEM_PROCESSOR ${limitsurf_zig_processor})
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  if(limitsurf_zig_system STREQUAL "windows")
    set(CMAKE_CROSSCOMPILING_EMULATOR wine)
  elseif(limitsurf_zig_system STREQUAL "macos")
    set(CMAKE_INSTALL_NAME_TOOL install_name_tool) # CMake wants one; only shared libraries need it
  endif()
endif()

set(CMAKE_C_COMPILER ${LIMITSURF_ZIG} cc -target ${LIMITSURF_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${LIMITSURF_ZIG} c++ -target ${LIMITSURF_ZIG_TARGET})

# These tools are commands of zig, but CMake takes only a program without arguments.
foreach(tool IN ITEMS ar ranlib)
  string(TOUPPER ${tool} limitsurf_zig_variable)
  set(limitsurf_zig_program ${CMAKE_BINARY_DIR}/zig-${tool})
  file(WRITE ${limitsurf_zig_program} "#!/bin/sh\nexec '${LIMITSURF_ZIG}' ${tool} \"$@\"\n")
  file(CHMOD ${limitsurf_zig_program} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  set(CMAKE_${limitsurf_zig_variable} ${limitsurf_zig_program})
endforeach()
