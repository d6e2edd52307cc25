# Finds the Open Dynamics Engine: the target broadmark::ode. Its installed headers know whether the
# library is single or double precision.
include("${CMAKE_CURRENT_LIST_DIR}/Library.cmake")
broadmark_library(ode ode/ode.h ode)
