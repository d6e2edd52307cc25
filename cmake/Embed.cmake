# Embeds files into the program.
#
# broadmark_embed(target header file...): `#include "header.h"` then gives, for every file, a
# function std::string_view broadmark::header::NAME(), NAME being its file name with '_' for every
# character that is invalid in an identifier.
function(broadmark_embed target header)
  set(declarations "")
  set(definitions "")
  foreach(file IN LISTS ARGN)
    get_filename_component(path ${file} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
    get_filename_component(file_name ${path} NAME)
    string(MAKE_C_IDENTIFIER ${file_name} name)
    list(APPEND paths ${path})
    string(APPEND declarations
      "std::string_view ${name}();  // NOLINT(readability-identifier-naming): the file's name\n")
    if(EMSCRIPTEN)
      string(APPEND definitions "
namespace {
const unsigned char ${header}_${name}[] = {
#embed \"${path}\"
};
}
std::string_view broadmark::${header}::${name}() {
  return {reinterpret_cast<const char*>(${header}_${name}), sizeof ${header}_${name}};
}
")
      continue()
    endif()
    # .incbin takes files of any size; a C++ literal is slow to compile and limited in length.
    string(APPEND definitions "
asm(R\"(.pushsection .rodata
${header}_${name}_begin: .incbin \"${path}\"
${header}_${name}_end: .byte 0
.popsection)\");
extern \"C\" const char ${header}_${name}_begin[], ${header}_${name}_end[];
std::string_view broadmark::${header}::${name}() {
  return {${header}_${name}_begin, ${header}_${name}_end};
}
")
  endforeach()
  set(base ${CMAKE_CURRENT_BINARY_DIR}/${header})
  file(CONFIGURE OUTPUT ${base}.h @ONLY CONTENT
    "#pragma once\n#include <string_view>\nnamespace broadmark::${header} {\n${declarations}}\n")
  file(CONFIGURE OUTPUT ${base}.cpp @ONLY CONTENT "#include \"${header}.h\"\n${definitions}")
  set_source_files_properties(${base}.cpp PROPERTIES OBJECT_DEPENDS "${paths}"
    SKIP_UNITY_BUILD_INCLUSION ON)  # a unity file drops OBJECT_DEPENDS
  if(EMSCRIPTEN)  # whose clang warns of #embed
    set_source_files_properties(${base}.cpp PROPERTIES COMPILE_OPTIONS -Wno-c23-extensions)
  endif()
  target_sources(${target} PRIVATE ${base}.cpp)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
