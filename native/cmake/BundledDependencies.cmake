# SPDX-License-Identifier: Apache-2.0
#
# For LIMITSURF_BUNDLED_DEPENDENCIES: OpenSubdiv and oneTBB are compiled from source and become a part
# of the library itself. What links the library then needs neither of them installed, and shares them
# with no other code of the process.
#
# Both sources are fetched, unless FETCHCONTENT_SOURCE_DIR_OPENSUBDIV and FETCHCONTENT_SOURCE_DIR_TBB
# name folders that hold them. So are Eigen's headers where Eigen is not installed
# (FETCHCONTENT_SOURCE_DIR_EIGEN).
include(FetchContent)

# The folder that SOURCE_SUBDIR names does not exist: OpenSubdiv's own CMake project, which looks for
# libraries of graphics cards, is left out.
FetchContent_Declare(opensubdiv
  URL https://github.com/PixarAnimationStudios/OpenSubdiv/archive/v3_5_0.tar.gz
  URL_HASH SHA256=8f5044f453b94162755131f77c08069004f25306fd6dc2192b6d49889efb8095
  SOURCE_SUBDIR none)
FetchContent_Declare(tbb
  URL https://github.com/oneapi-src/oneTBB/archive/refs/tags/v2021.8.0.tar.gz
  URL_HASH SHA256=eee380323bb7ce864355ed9431f85c43955faaae9e9bce35c62b372d7ffd9f8b
  SOURCE_SUBDIR none)
FetchContent_MakeAvailable(opensubdiv tbb)

find_package(Eigen3 3.4 CONFIG QUIET)
if(NOT Eigen3_FOUND)
  FetchContent_Declare(eigen
    URL https://gitlab.com/libeigen/eigen/-/archive/3.4.0/eigen-3.4.0.tar.bz2
    URL_HASH SHA256=b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
    SOURCE_SUBDIR none)
  FetchContent_MakeAvailable(eigen)
  add_library(Eigen3::Eigen INTERFACE IMPORTED GLOBAL)
  target_include_directories(Eigen3::Eigen INTERFACE ${eigen_SOURCE_DIR})
endif()

# The library needs the first three parts of OpenSubdiv; tests and benchmarks compare it with Bfr.
file(GLOB LIMITSURF_OPENSUBDIV_SOURCES CONFIGURE_DEPENDS
  ${opensubdiv_SOURCE_DIR}/opensubdiv/far/*.cpp
  ${opensubdiv_SOURCE_DIR}/opensubdiv/sdc/*.cpp
  ${opensubdiv_SOURCE_DIR}/opensubdiv/vtr/*.cpp
  ${opensubdiv_SOURCE_DIR}/opensubdiv/bfr/*.cpp)
add_library(limitsurf_opensubdiv OBJECT ${LIMITSURF_OPENSUBDIV_SOURCES})
target_include_directories(limitsurf_opensubdiv PRIVATE ${opensubdiv_SOURCE_DIR})

file(GLOB LIMITSURF_TBB_SOURCES CONFIGURE_DEPENDS ${tbb_SOURCE_DIR}/src/tbb/*.cpp)
add_library(limitsurf_tbb OBJECT ${LIMITSURF_TBB_SOURCES})
target_include_directories(limitsurf_tbb PRIVATE ${tbb_SOURCE_DIR}/include)
target_compile_definitions(limitsurf_tbb
  PRIVATE __TBB_BUILD __TBB_DYNAMIC_LOAD_ENABLED=0 __TBB_SOURCE_DIRECTLY_INCLUDED=1)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND NOT MSVC)
  # oneTBB uses these instructions where it finds that the CPU has them.
  target_compile_options(limitsurf_tbb PRIVATE -mrtm -mwaitpkg)
endif()
if(APPLE)
  target_compile_definitions(limitsurf_tbb PRIVATE _XOPEN_SOURCE) # for the functions in ucontext.h
endif()

foreach(part IN ITEMS limitsurf_opensubdiv limitsurf_tbb)
  set_target_properties(${part} PROPERTIES CXX_CLANG_TIDY "" EXPORT_COMPILE_COMMANDS OFF)
  target_compile_definitions(${part} PRIVATE _USE_MATH_DEFINES)
  target_compile_options(${part} PRIVATE $<IF:$<CXX_COMPILER_ID:MSVC>,/w,-w>)
endforeach()

# What includes their headers, in place of the targets of their packages; the library has their
# objects.
find_package(Threads REQUIRED)
add_library(limitsurf_opensubdiv_headers INTERFACE)
if(WIN32)
  target_compile_definitions(limitsurf_opensubdiv_headers INTERFACE _USE_MATH_DEFINES)
endif()
target_include_directories(limitsurf_opensubdiv_headers SYSTEM INTERFACE ${opensubdiv_SOURCE_DIR})
add_library(limitsurf_tbb_headers INTERFACE)
target_include_directories(limitsurf_tbb_headers SYSTEM INTERFACE ${tbb_SOURCE_DIR}/include)
set(LIMITSURF_OPENSUBDIV limitsurf_opensubdiv_headers)
set(LIMITSURF_TBB limitsurf_tbb_headers)
