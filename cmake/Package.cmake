# `cpack` in the build folder makes two Debian packages of the installed files: the library for engines
# and games (component broadphase), and all the rest, which includes it.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME broadmark)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_DEPENDS "libbroadmark-broadphase-dev (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_BROADPHASE_PACKAGE_NAME libbroadmark-broadphase-dev)
set(CPACK_DEBIAN_BROADPHASE_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_BROADPHASE_PACKAGE_SUGGESTS "cmake, g++, make, pkg-config")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_CONTACT "Broadmark developers <broadmark@localhost>")
# Each begins with its summary.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "${PROJECT_DESCRIPTION}
Broadmark generates physics scenes, records them, runs broad-phase algorithms
on exactly the same boxes, checks every answer and measures every phase. The
package contains the program, and libraries for measuring your own broad
phase.")
set(CPACK_COMPONENT_BROADPHASE_DESCRIPTION "Broad-phase collision detection, for engines and games
Finds the pairs of bodies whose boxes overlap, or the changes to these pairs,
from frame to frame. For C++ and C; depends on the C++ standard library alone.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # linked libraries

# Recommended: libraries loaded at run time, if present. Suggested: dependencies for building with the
# libraries, an OpenCL device without a GPU, the Python package, counting instructions.
set(recommended "")
set(suggested cmake g++ make libbullet-dev libfmt-dev valgrind)
if(BROADMARK_RENDER)
  list(APPEND recommended libegl1 libosmesa6)
endif()
if(BROADMARK_INSPECTOR)
  list(APPEND recommended libgl1)
endif()
if(BROADMARK_PYTHON)
  list(APPEND suggested python3-numpy python3-pandas python3-matplotlib node-d3)
endif()
if(BROADMARK_EMBREE)
  list(APPEND suggested libembree-dev libtbb-dev)
endif()
if(BROADMARK_FCL)
  list(APPEND suggested libfcl-dev)
endif()
if(BROADMARK_ODE)
  list(APPEND suggested libode-dev)
endif()
if(BROADMARK_OPENCL)
  list(APPEND suggested ocl-icd-opencl-dev pocl-opencl-icd)
endif()
list(JOIN recommended ", " CPACK_DEBIAN_UNSPECIFIED_PACKAGE_RECOMMENDS)
list(JOIN suggested ", " CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS)

include(CPack)
