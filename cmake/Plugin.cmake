# A plug-in (broadmark/plugin.h) made of these files:
#   broadmark_add_plugin(NAME FILE...)
# Without a build type it is optimised nevertheless, as it is there to be measured. Results name the
# flags that it was built with.
function(broadmark_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE broadmark::broadmark)
  get_property(several_types GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
  if(several_types)
    return()  # only the build tells which
  endif()
  set(type RELEASE)
  if(CMAKE_BUILD_TYPE)
    string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  else()
    separate_arguments(flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS_RELEASE}")
    target_compile_options(${name} PRIVATE ${flags})
  endif()
  string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}" flags)
  string(REPLACE "\"" "" flags "${flags}")
  target_compile_definitions(${name} PRIVATE "BROADMARK_BUILD_FLAGS=\"${flags}\"")
endfunction()
