# Finds a library that has no package of CMake's, or one that asks for more than we use: the target
# broadmark::NAME. Installed, too, as programs that link our libraries link those that these use.
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
