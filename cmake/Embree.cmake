# Finds Embree 4 or 3 and its task scheduler TBB: the targets broadmark::embree and broadmark::tbb.
include("${CMAKE_CURRENT_LIST_DIR}/Library.cmake")
broadmark_library(embree "embree4/rtcore.h;embree3/rtcore.h" "embree4;embree3")
broadmark_library(tbb tbb/task_arena.h tbb)
