# SPDX-License-Identifier: Apache-2.0
#
# Finds OpenSubdiv's CPU library by its files, as the target that OpenSubdiv's own CMake package
# calls OpenSubdiv::osdCPU. Debian needs this: its package's CMake config names a library that the
# package does not contain, and fails.
include(FindPackageHandleStandardArgs)

find_path(OPENSUBDIV_INCLUDE_DIR opensubdiv/far/topologyRefiner.h)
find_library(OPENSUBDIV_CPU_LIBRARY osdCPU)
mark_as_advanced(OPENSUBDIV_INCLUDE_DIR OPENSUBDIV_CPU_LIBRARY)

find_package_handle_standard_args(OpenSubdivCpu
  REQUIRED_VARS OPENSUBDIV_CPU_LIBRARY OPENSUBDIV_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "On Debian: apt-get install libosd-dev")

if(OpenSubdivCpu_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
  add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
  set_target_properties(OpenSubdiv::osdCPU PROPERTIES
    IMPORTED_LOCATION ${OPENSUBDIV_CPU_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENSUBDIV_INCLUDE_DIR})
endif()
