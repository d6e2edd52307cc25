# Finds OpenCL, and Bullet's algorithms on it: the targets OpenCL::OpenCL and broadmark::bullet_opencl.
# Installed, because programs that link the algorithms also link these.
find_package(OpenCL REQUIRED)
find_path(BROADMARK_BULLET3_INCLUDE_DIR Bullet3OpenCL/Initialize/b3OpenCLUtils.h
  PATH_SUFFIXES bullet REQUIRED)
find_library(BROADMARK_BULLET3_OPENCL_LIBRARY Bullet3OpenCL_clew REQUIRED)
find_library(BROADMARK_BULLET3_COMMON_LIBRARY Bullet3Common REQUIRED)
if(NOT TARGET broadmark::bullet_opencl)
  add_library(broadmark::bullet_opencl UNKNOWN IMPORTED GLOBAL)
  set_target_properties(broadmark::bullet_opencl PROPERTIES
    IMPORTED_LOCATION "${BROADMARK_BULLET3_OPENCL_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${BROADMARK_BULLET3_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${BROADMARK_BULLET3_COMMON_LIBRARY}")
endif()
