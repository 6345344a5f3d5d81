# SPDX-License-Identifier: Apache-2.0
# Libraries that the plugins stand on (ref/plugin/plugin.hpp). A program that links kage needs none of them to build.
find_package(assimp REQUIRED)
if(NOT KAGE_OPENIMAGEIO)
  return()
endif()
set(CMAKE_MESSAGE_LOG_LEVEL_kept ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # Imath, which it asks for, talks about a Python library nobody wants
find_package(OpenImageIO REQUIRED QUIET)
set(CMAKE_MESSAGE_LOG_LEVEL ${CMAKE_MESSAGE_LOG_LEVEL_kept})

find_package(LibWebP REQUIRED)
find_package(TIFF REQUIRED)

# Debian 12's OpenImageIO names folders of packages that it does not depend on (opencv).
get_target_property(kage_oiio_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(kage_oiio_present)
foreach(dir IN LISTS kage_oiio_dirs)
  if(EXISTS ${dir})
    list(APPEND kage_oiio_present ${dir})
  endif()
endforeach()
set_property(TARGET OpenImageIO::OpenImageIO PROPERTY INTERFACE_INCLUDE_DIRECTORIES ${kage_oiio_present})
