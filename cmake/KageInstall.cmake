# SPDX-License-Identifier: Apache-2.0
# bin/kage, the golden model as a CMake package, and under share/kage all that an installed kage needs to build RTL models.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kage)

install(TARGETS kage kage_order kage_golden EXPORT kageTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} FILE_SET HEADERS)
if(TARGET kage_cosim_package)
  install(TARGETS kage_cosim_package EXPORT kageTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} FILE_SET HEADERS)
endif()
install(EXPORT kageTargets NAMESPACE kage:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/kageConfig.cmake.in ${PROJECT_BINARY_DIR}/kageConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kageConfig.cmake ${PROJECT_BINARY_DIR}/kageConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/KageDependencies.cmake DESTINATION ${package_dir})

install(DIRECTORY rtl scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kage)
install(DIRECTORY verif/cosim/report/page DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/cosim/report)
install(DIRECTORY verif/explore/page DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/explore)
install(DIRECTORY verif/cosim/model/cells verif/cosim/model/driver DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/cosim/model USE_SOURCE_PERMISSIONS)
install(FILES verif/cosim/model/faults.yaml DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/cosim/model)
# A board in simulation: kage board --port sim:BOARD.
install(DIRECTORY constraints/boards DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/constraints)
install(FILES constraints/figures.json DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/constraints)
install(DIRECTORY verif/board/sim DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/board USE_SOURCE_PERMISSIONS)
install(DIRECTORY verif/vectors/bench DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/vectors)
install(DIRECTORY verif/cosim/diverge/monitors DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/cosim/diverge)

# Documents for people: the pages as their links to each other expect them, and the testbenches that docs/testbenches.md shows.
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES scenes/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/scenes)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "__pycache__" EXCLUDE)
install(FILES python/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/python)

# For builds without CMake: pkg-config --cflags --libs kage. The static libraries ask for what they are linked with.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(kage_pc_libdir ${CMAKE_INSTALL_LIBDIR})
  set(kage_pc_includedir ${CMAKE_INSTALL_INCLUDEDIR})
else()
  set(kage_pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
  set(kage_pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
function(kage_pkg_config name description requires libs)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.pc @ONLY CONTENT [[
prefix=${pcfiledir}/@kage_pc_up@
libdir=@kage_pc_libdir@
includedir=@kage_pc_includedir@

Name: @name@
Description: @description@
Version: @PROJECT_VERSION@
Requires: @requires@
Libs: -L${libdir} @libs@
Cflags: -I${includedir}
]])
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
file(RELATIVE_PATH kage_pc_up ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX}) # a prefix may be moved
kage_pkg_config(kage "kage's golden model, front end and scenes (static)" "kage-order yaml-cpp zlib libpng" "-lkage -ldl")
kage_pkg_config(kage-order "visibility order by BSP tree (static)" "fmt tbb libhwy" "-lkage_order -pthread")
if(TARGET kage_cosim_package)
  kage_pkg_config(kage-cosim "kage's co-simulation of golden model and RTL (static)" "kage libcrypto" "-lkage_cosim")
endif()
kage_pkg_config(kage-golden "kage's golden core behind C functions" "" "-lkage_golden")

# The man page and the completions are what the program says of itself.
if(TARGET kage_cli)
  set(texts)
  foreach(text man:kage.1 bash:kage.bash zsh:_kage)
    string(REPLACE ":" ";" text ${text})
    list(GET text 0 form)
    list(GET text 1 file)
    set(file ${PROJECT_BINARY_DIR}/share/${file})
    add_custom_command(OUTPUT ${file} COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/share
                       COMMAND kage_cli help --${form} > ${file} DEPENDS kage_cli VERBATIM)
    list(APPEND texts ${file})
  endforeach()
  add_custom_target(kage_texts ALL DEPENDS ${texts})
  install(FILES ${PROJECT_BINARY_DIR}/share/kage.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${PROJECT_BINARY_DIR}/share/kage.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME kage)
  install(FILES ${PROJECT_BINARY_DIR}/share/_kage DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endif()
