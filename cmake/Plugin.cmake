# Builds a plug-in (broadmark/plugin.h) from these files:
#   broadmark_add_plugin(NAME FILE...)
# It is optimised even without a build type, because it will be measured. Results record its compiler
# flags.
function(broadmark_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE broadmark::broadmark)
  get_property(several_types GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
  if(several_types)
    return()  # the build type is unknown at configure time
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
