# Quick builds: headers compiled once for many files, and ccache where it is installed. (The presets
# also make CMake compile several files as one: CMAKE_UNITY_BUILD.)
#
# Sources include what they use all the same: every file compiles without this, too
# (CMAKE_DISABLE_PRECOMPILE_HEADERS; `./check --lint` does so).

# The headers of libraries that most of our files include.
set(broadmark_heavy_headers <algorithm> <array> <chrono> <cmath> <cstdint> <deque> <filesystem>
  <functional> <limits> <map> <memory> <optional> <set> <span> <string> <string_view> <thread>
  <utility> <vector> <fmt/format.h>)

# A second build of the same sources, in this folder or in another clone, then takes a minute.
find_program(BROADMARK_CCACHE ccache DOC "Caches what is compiled; empty: not used")
if(BROADMARK_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache must overlook to work with precompiled headers (its manual), and to find the same
  # file in another folder.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    ${BROADMARK_CCACHE})
endif()
