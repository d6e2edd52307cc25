# WebAssembly with Debian's emscripten; libraries are in BROADMARK_WEB_PREFIX: see scripts/build-web.
# BROADMARK_WEB_PLAIN: for browsers without vectors, and pages without threads.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BROADMARK_WEB_PREFIX BROADMARK_WEB_PLAIN)
list(APPEND CMAKE_FIND_ROOT_PATH ${BROADMARK_WEB_PREFIX})
list(APPEND CMAKE_PREFIX_PATH ${BROADMARK_WEB_PREFIX})
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(flags "-fwasm-exceptions")
if(NOT BROADMARK_WEB_PLAIN)
  string(APPEND flags " -msimd128 -pthread")
endif()
string(APPEND CMAKE_C_FLAGS_INIT " ${flags}")
string(APPEND CMAKE_CXX_FLAGS_INIT " ${flags}")
