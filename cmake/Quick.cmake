# Faster builds: precompiled headers, and ccache if installed. (The presets also enable unity builds:
# CMAKE_UNITY_BUILD.)
#
# Sources still include what they use: every file compiles without precompiled headers
# (CMAKE_DISABLE_PRECOMPILE_HEADERS; `./check --lint` and `--asan` do so).

# Library headers that most files include.
set(broadmark_heavy_headers <algorithm> <array> <chrono> <cmath> <cstdint> <deque> <filesystem>
  <functional> <limits> <map> <memory> <optional> <set> <span> <string> <string_view> <thread>
  <utility> <vector> <fmt/format.h>)

# Rebuilding the same sources, here or in another clone, then takes a minute.
find_program(BROADMARK_CCACHE ccache DOC "Caches what is compiled; empty: not used")
# Not for browsers: ccache does not see what #embed reads (see Embed.cmake).
if(BROADMARK_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND NOT EMSCRIPTEN)
  # Sloppiness that ccache needs for precompiled headers (see its manual), and a base directory to find
  # the same file in another folder.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    ${BROADMARK_CCACHE})
endif()
