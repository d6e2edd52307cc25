# Installs and exports the program and the libraries: find_package(broadmark) provides
# broadmark::engine, broadmark::algorithms and broadmark::scenes, and the program for plug-ins to link
# to. Its component plugin needs nothing but a compiler. Its component broadphase, which can be installed
# alone, provides broadmark::broadphase and broadmark::broadphase_static.
include(CMakePackageConfigHelpers)

set(installed broadmark_engine broadmark_core broadmark_statistics broadmark_recordings broadmark_harness
  broadmark_algorithms)
if(BROADMARK_APP)
  list(APPEND installed broadmark_scenes)
  install(TARGETS broadmark EXPORT broadmark_program_targets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS ${installed} EXPORT broadmark_targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# Find modules of the libraries' dependencies.
set(dependencies Library Bullet)
if(BROADMARK_EMBREE)
  list(APPEND dependencies Embree)
endif()
if(BROADMARK_FCL)
  list(APPEND dependencies Fcl)
endif()
if(BROADMARK_ODE)
  list(APPEND dependencies Ode)
endif()
if(BROADMARK_OPENCL)
  list(APPEND dependencies OpenCL)
endif()
list(TRANSFORM dependencies APPEND .cmake)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/broadmark)
install(EXPORT broadmark_targets NAMESPACE broadmark:: DESTINATION ${package_dir})
if(BROADMARK_APP)
  install(EXPORT broadmark_program_targets NAMESPACE broadmark:: FILE program_targets.cmake
    DESTINATION ${package_dir})
endif()
configure_package_config_file(cmake/broadmarkConfig.cmake.in
  ${PROJECT_BINARY_DIR}/broadmarkConfig.cmake INSTALL_DESTINATION ${package_dir})
install(TARGETS broadmark_broadphase_shared broadmark_broadphase_static
  EXPORT broadmark_broadphase_targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT broadphase
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT broadphase
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT broadphase)
if(BROADMARK_APP)  # building the program builds all that is installed with it
  add_dependencies(broadmark broadmark_broadphase_shared broadmark_broadphase_static)
endif()
install(EXPORT broadmark_broadphase_targets NAMESPACE broadmark:: FILE broadphase_targets.cmake
  DESTINATION ${package_dir} COMPONENT broadphase)
file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(broadphase/broadmark-broadphase.pc.in
  ${PROJECT_BINARY_DIR}/broadmark-broadphase.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/broadmark-broadphase.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT broadphase)
set(library_documents ${CMAKE_INSTALL_DATADIR}/doc/libbroadmark-broadphase-dev)
install(FILES LICENSE DESTINATION ${library_documents} RENAME copyright COMPONENT broadphase)
file(READ docs/embedding.md embedding)  # without the links, which lead out of the package
string(REGEX REPLACE "\\[([^]]*)\\]\\([^)]*\\)" "\\1" embedding "${embedding}")
file(WRITE ${PROJECT_BINARY_DIR}/embedding.md "${embedding}")
install(FILES ${PROJECT_BINARY_DIR}/embedding.md DESTINATION ${library_documents}
  COMPONENT broadphase)
install(DIRECTORY broadphase/examples DESTINATION ${library_documents} COMPONENT broadphase)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/broadmarkConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/broadmarkConfig.cmake
  ${PROJECT_BINARY_DIR}/broadmarkConfigVersion.cmake DESTINATION ${package_dir}
  COMPONENT broadphase)
list(TRANSFORM dependencies PREPEND cmake/ OUTPUT_VARIABLE finders)
install(FILES ${finders} cmake/Plugin.cmake DESTINATION ${package_dir})

# Manual page and completion scripts, printed by the program at install time (not when
# cross-compiling).
if(BROADMARK_APP AND NOT CMAKE_CROSSCOMPILING)
  set(printed ${PROJECT_BINARY_DIR}/printed)
  function(broadmark_install_printed directory file)
    install(CODE "
      file(MAKE_DIRECTORY \"${printed}\")
      execute_process(COMMAND \"$<TARGET_FILE:broadmark>\" ${ARGN}
        OUTPUT_FILE \"${printed}/${file}\" COMMAND_ERROR_IS_FATAL ANY)")
    install(FILES ${printed}/${file} DESTINATION ${directory})
  endfunction()
  broadmark_install_printed(${CMAKE_INSTALL_MANDIR}/man1 broadmark.1 manual)
  set(data ${CMAKE_INSTALL_DATADIR})
  broadmark_install_printed(${data}/bash-completion/completions broadmark completion bash)
  broadmark_install_printed(${data}/zsh/vendor-completions _broadmark completion zsh)
  broadmark_install_printed(${data}/fish/vendor_completions.d broadmark.fish completion fish)
endif()

# Documents and the files that they link to, in folders that match the links.
include(cmake/Copyright.cmake)
install(FILES ${PROJECT_BINARY_DIR}/copyright README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md
  LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs integrations DESTINATION ${CMAKE_INSTALL_DOCDIR}
  PATTERN __pycache__ EXCLUDE PATTERN docs/site EXCLUDE)
install(DIRECTORY assets/scenes assets/pictures assets/workflows DESTINATION ${CMAKE_INSTALL_DOCDIR}/assets)
install(DIRECTORY python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/python
  PATTERN .ipynb_checkpoints EXCLUDE)
install(DIRECTORY broadphase/examples broadphase/include DESTINATION ${CMAKE_INSTALL_DOCDIR}/broadphase)
install(DIRECTORY plugins/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/plugins)
install(FILES scripts/packages.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}/scripts)
