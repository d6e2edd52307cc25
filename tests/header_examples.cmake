# Compiles the examples in the first comments of public headers: the indented lines after "// Example:", each
# as the body of a function.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*/include/broadmark/*.h
  ${PROJECT_SOURCE_DIR}/engine/*/include/broadmark/*.h)
set(sources "")
foreach(header IN LISTS headers)
  file(READ ${header} text)
  if(NOT text MATCHES "\n// Example:\n//\n((//   [^\n]*\n|//\n)+)#pragma once")
    continue()
  endif()
  string(REGEX REPLACE "(^|\n)// ?" "\\1" body "${CMAKE_MATCH_1}")
  string(REGEX REPLACE ".*/include/" "" name ${header})
  string(MAKE_C_IDENTIFIER ${name} identifier)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/header_examples/${identifier}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT
    "#include \"@name@\"\n\nvoid @identifier@() {\n  using namespace broadmark;\n@body@}\n")
  list(APPEND sources ${source})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
endforeach()

add_library(broadmark_header_examples OBJECT ${sources})
broadmark_configure(broadmark_header_examples)
target_link_libraries(broadmark_header_examples PRIVATE broadmark_harness broadmark_algorithms broadmark_scenes)
target_compile_options(broadmark_header_examples PRIVATE -Wno-unused -Wno-missing-declarations)
