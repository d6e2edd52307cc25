# Finds the Open Dynamics Engine: the target broadmark::ode. Its headers define the
# precision.
include("${CMAKE_CURRENT_LIST_DIR}/Library.cmake")
broadmark_library(ode ode/ode.h ode)
