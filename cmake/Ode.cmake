# Finds the Open Dynamics Engine: the target broadmark::ode. Installed, too, as programs that link
# the scenes link it.
#
# ODE's installed headers know whether the library is single or double precision.
find_path(BROADMARK_ODE_INCLUDE_DIR ode/ode.h REQUIRED)
find_library(BROADMARK_ODE_LIBRARY ode REQUIRED)
if(NOT TARGET broadmark::ode)
  add_library(broadmark::ode UNKNOWN IMPORTED GLOBAL)
  set_target_properties(broadmark::ode PROPERTIES IMPORTED_LOCATION "${BROADMARK_ODE_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${BROADMARK_ODE_INCLUDE_DIR}")
endif()
