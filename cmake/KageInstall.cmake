# SPDX-License-Identifier: Apache-2.0
# bin/kage, the golden model as a CMake package, and under share/kage all that an installed kage needs to build RTL models.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kage)

install(TARGETS kage kage_order kage_golden EXPORT kageTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} FILE_SET HEADERS)
install(EXPORT kageTargets NAMESPACE kage:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/kageConfig.cmake.in ${PROJECT_BINARY_DIR}/kageConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kageConfig.cmake ${PROJECT_BINARY_DIR}/kageConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/KageDependencies.cmake DESTINATION ${package_dir})

install(DIRECTORY rtl scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kage)
install(DIRECTORY verif/report/page DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif/report)
install(DIRECTORY verif/rtl_model verif/monitors verif/faults DESTINATION ${CMAKE_INSTALL_DATADIR}/kage/verif USE_SOURCE_PERMISSIONS OPTIONAL)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
