# Finds the Flexible Collision Library: the target broadmark::fcl.
include("${CMAKE_CURRENT_LIST_DIR}/Library.cmake")
broadmark_library(fcl fcl/fcl.h fcl)
