# SPDX-License-Identifier: Apache-2.0
#
# For Windows on x86-64, compiled elsewhere by MinGW-w64 (Debian: g++-mingw-w64-x86-64-posix). Wine
# runs the programs. It needs LIMITSURF_BUNDLED_DEPENDENCIES and LIMITSURF_BUNDLED_TEST_LIBRARIES,
# and in CMAKE_PREFIX_PATH a folder with the headers and the CMake packages of Eigen and Boost.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_CROSSCOMPILING_EMULATOR wine)
# The programs need no libraries of the compiler beside them. Debug sections of templates exceed what
# an object file holds otherwise.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CXX_FLAGS_INIT -Wa,-mbig-obj)

set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
