# Finds a library without a CMake package, or with one that requires more than we use: the target
# broadmark::NAME. Installed, because programs that link our libraries also link their dependencies.
#
# broadmark_library(name header library)
function(broadmark_library name header library)
  string(TOUPPER ${name} upper)
  find_path(BROADMARK_${upper}_INCLUDE_DIR ${header} REQUIRED)
  find_library(BROADMARK_${upper}_LIBRARY ${library} REQUIRED)
  if(NOT TARGET broadmark::${name})
    add_library(broadmark::${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(broadmark::${name} PROPERTIES
      IMPORTED_LOCATION "${BROADMARK_${upper}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${BROADMARK_${upper}_INCLUDE_DIR}")
  endif()
endfunction()
