# SPDX-License-Identifier: Apache-2.0
# All libraries come from Debian (tools/deps). kageConfig.cmake includes this file too, so that both ask for the same.
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(TBB REQUIRED)
find_package(glm REQUIRED)
find_package(assimp REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL_kept ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # Imath, which it asks for, talks about a Python library nobody wants
find_package(OpenImageIO REQUIRED QUIET)
set(CMAKE_MESSAGE_LOG_LEVEL ${CMAKE_MESSAGE_LOG_LEVEL_kept})
find_package(hwy REQUIRED)
find_package(Threads REQUIRED)
if(NOT TARGET yaml-cpp::yaml-cpp) # yaml-cpp 0.7 (Debian 12) calls it yaml-cpp
  add_library(yaml-cpp::yaml-cpp INTERFACE IMPORTED)
  set_property(TARGET yaml-cpp::yaml-cpp PROPERTY INTERFACE_LINK_LIBRARIES yaml-cpp)
endif()

# Debian 12's OpenImageIO names folders of packages that it does not depend on (opencv).
get_target_property(kage_oiio_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(kage_oiio_present)
foreach(dir IN LISTS kage_oiio_dirs)
  if(EXISTS ${dir})
    list(APPEND kage_oiio_present ${dir})
  endif()
endforeach()
set_property(TARGET OpenImageIO::OpenImageIO PROPERTY INTERFACE_INCLUDE_DIRECTORIES ${kage_oiio_present})
