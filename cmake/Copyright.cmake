# The file "copyright": our licence, and those of linked-in code, copied from its Debian
# packages.
file(READ LICENSE copyright)
if(BROADMARK_CGAL)
  string(APPEND copyright "
The algorithm \"cgal\" is CGAL's box intersection, with headers under the GPL-3: therefore this
program as a whole, and the library broadmark::algorithms, are also under the GPL-3
(/usr/share/common-licenses/GPL-3). Broadmark configured with BROADMARK_CGAL=OFF is not.
")
endif()

set(packages libbullet-dev libcli11-dev libeigen3-dev libfmt-dev libxxhash-dev nlohmann-json3-dev
  zlib1g-dev)
if(BROADMARK_CGAL)
  list(APPEND packages libcgal-dev)
endif()
if(BROADMARK_BOOST)
  list(APPEND packages libboost-dev)
endif()
if(BROADMARK_EMBREE)
  list(APPEND packages libtbb-dev)
endif()
if(BROADMARK_FCL)
  list(APPEND packages libfcl-dev)
endif()
if(BROADMARK_RENDER)
  list(APPEND packages fonts-inter libstb-dev)
endif()
if(BROADMARK_INSPECTOR)
  list(APPEND packages libimgui-dev)
endif()
foreach(package IN LISTS packages)
  set(notice /usr/share/doc/${package}/copyright)
  string(APPEND copyright "\n==== Contains code of the Debian package ${package} ====\n\n")
  if(EXISTS ${notice})
    file(READ ${notice} text)
    string(APPEND copyright "${text}")
  endif()
endforeach()
file(WRITE ${PROJECT_BINARY_DIR}/copyright "${copyright}")
