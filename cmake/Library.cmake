# Finds a library without a CMake package, or with one that requires more than we use: the target
# broadmark::NAME. Installed, because programs that link our libraries also link their dependencies.
#
# broadmark_library(name headers libraries): alternative names, the preferred first
function(broadmark_library name headers libraries)
  string(TOUPPER ${name} upper)
  find_path(BROADMARK_${upper}_INCLUDE_DIR NAMES ${headers} REQUIRED)
  find_library(BROADMARK_${upper}_LIBRARY NAMES ${libraries} REQUIRED)
  if(NOT TARGET broadmark::${name})
    add_library(broadmark::${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(broadmark::${name} PROPERTIES
      IMPORTED_LOCATION "${BROADMARK_${upper}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${BROADMARK_${upper}_INCLUDE_DIR}")
  endif()
endfunction()
