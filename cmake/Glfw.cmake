# Finds GLFW: the target glfw. Emscripten has its own, in JavaScript.
if(EMSCRIPTEN)
  add_library(glfw INTERFACE)
  target_link_options(glfw INTERFACE -sUSE_GLFW=3 -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2)
else()
  find_package(glfw3 REQUIRED)
endif()
