# SPDX-License-Identifier: Apache-2.0
#
# For LIMITSURF_BUNDLED_TEST_LIBRARIES: GoogleTest and Google Benchmark are compiled from source, for
# a target or a C++ standard library that is not the system's.
#
# Both sources are fetched, unless FETCHCONTENT_SOURCE_DIR_GOOGLETEST and
# FETCHCONTENT_SOURCE_DIR_BENCHMARK name folders that hold them.
include(FetchContent)

set(INSTALL_GTEST OFF)
set(BENCHMARK_ENABLE_GTEST_TESTS OFF)
set(BENCHMARK_ENABLE_INSTALL OFF)
set(BENCHMARK_ENABLE_TESTING OFF)
set(BENCHMARK_ENABLE_WERROR OFF)
set(CMAKE_POLICY_DEFAULT_CMP0077 NEW) # their options take these variables
set(gtest_force_shared_crt ON)
set(limitsurf_test_libraries)
set(limitsurf_warning_as_error ${CMAKE_COMPILE_WARNING_AS_ERROR})
set(CMAKE_COMPILE_WARNING_AS_ERROR OFF)

if(LIMITSURF_BUILD_TESTS OR LIMITSURF_BUILD_TOOLS)
  FetchContent_Declare(googletest
    URL https://github.com/google/googletest/archive/refs/tags/release-1.12.1.tar.gz
    URL_HASH SHA256=81964fe578e9bd7c94dfdb09c8e4d6e6759e19967e397dbea48d1c10e45d0df2)
  FetchContent_MakeAvailable(googletest)
  list(APPEND limitsurf_test_libraries gtest gtest_main gmock gmock_main)
endif()
if(LIMITSURF_BUILD_BENCH)
  FetchContent_Declare(benchmark
    URL https://github.com/google/benchmark/archive/refs/tags/v1.7.1.tar.gz
    URL_HASH SHA256=6430e4092653380d9dc4ccb45a1e2dc9259d581f4866dc0759713126056bc1d7)
  FetchContent_MakeAvailable(benchmark)
  list(APPEND limitsurf_test_libraries benchmark benchmark_main)
endif()

foreach(library IN LISTS limitsurf_test_libraries)
  set_target_properties(${library} PROPERTIES CXX_CLANG_TIDY "" EXPORT_COMPILE_COMMANDS OFF)
  target_compile_options(${library} PRIVATE $<IF:$<CXX_COMPILER_ID:MSVC>,/w,-w>)
endforeach()
set(CMAKE_COMPILE_WARNING_AS_ERROR ${limitsurf_warning_as_error})
