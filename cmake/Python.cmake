# The package's Python interpreter, and pybind11.
set(PYBIND11_FINDPYTHON ON)
if(EXISTS /usr/bin/python3)  # the system's, with Debian's Python packages
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that the package is for")
endif()
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 REQUIRED)
