# SPDX-License-Identifier: Apache-2.0
# libwebp, whose CMake files Debian 12 does not have: LibWebP::LibWebP.
include(FindPackageHandleStandardArgs)
find_path(LibWebP_INCLUDE_DIR webp/decode.h)
find_library(LibWebP_LIBRARY webp)
mark_as_advanced(LibWebP_INCLUDE_DIR LibWebP_LIBRARY)
find_package_handle_standard_args(LibWebP REQUIRED_VARS LibWebP_LIBRARY LibWebP_INCLUDE_DIR)
if(LibWebP_FOUND AND NOT TARGET LibWebP::LibWebP)
  add_library(LibWebP::LibWebP UNKNOWN IMPORTED)
  set_target_properties(LibWebP::LibWebP PROPERTIES IMPORTED_LOCATION "${LibWebP_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${LibWebP_INCLUDE_DIR}")
endif()
