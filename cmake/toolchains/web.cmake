# WebAssembly with Debian's emscripten; libraries are in BROADMARK_WEB_PREFIX: see scripts/build-web.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BROADMARK_WEB_PREFIX)
list(APPEND CMAKE_FIND_ROOT_PATH ${BROADMARK_WEB_PREFIX})
list(APPEND CMAKE_PREFIX_PATH ${BROADMARK_WEB_PREFIX})
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
string(APPEND CMAKE_C_FLAGS_INIT " -msimd128 -fwasm-exceptions -pthread")
string(APPEND CMAKE_CXX_FLAGS_INIT " -msimd128 -fwasm-exceptions -pthread")
