# Installs the program and the two libraries, and exports them as a package: find_package(broadmark)
# gives broadmark::engine and broadmark::algorithms, and the program for plug-ins to link to.
include(CMakePackageConfigHelpers)

set(installed broadmark_engine broadmark_algorithms)
if(BROADMARK_APP)
  list(APPEND installed broadmark)
endif()
install(TARGETS ${installed} EXPORT broadmark_targets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/broadmark)
install(EXPORT broadmark_targets NAMESPACE broadmark:: DESTINATION ${package_dir})
configure_package_config_file(cmake/broadmarkConfig.cmake.in
  ${PROJECT_BINARY_DIR}/broadmarkConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/broadmarkConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/broadmarkConfig.cmake
  ${PROJECT_BINARY_DIR}/broadmarkConfigVersion.cmake cmake/Bullet.cmake DESTINATION ${package_dir})
