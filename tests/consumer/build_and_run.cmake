# Installs Broadmark into a fresh prefix, then configures, builds and runs the project beside this
# file against it. Arguments: BUILD_DIR, SOURCE_DIR, WORK_DIR, COMPILER; PYTHON: the interpreter that
# the Python package was installed for, empty if it was left out.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${WORK_DIR}/prefix")
foreach(printed man/man1/broadmark.1 bash-completion/completions/broadmark
    zsh/vendor-completions/_broadmark fish/vendor_completions.d/broadmark.fish)
  file(READ "${WORK_DIR}/prefix/share/${printed}" text)
  if(NOT text MATCHES "headless")
    message(FATAL_ERROR "${printed}: names no options")
  endif()
endforeach()
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${WORK_DIR}/build"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix" "-DCMAKE_CXX_COMPILER=${COMPILER}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/build")
run("${WORK_DIR}/build/my_broad_phase")
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}/plugins" -B "${WORK_DIR}/plugins"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix" "-DCMAKE_CXX_COMPILER=${COMPILER}"
  -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON)
run(${CMAKE_COMMAND} --build "${WORK_DIR}/plugins")
run("${WORK_DIR}/prefix/bin/broadmark" --version)
run("${WORK_DIR}/prefix/bin/broadmark" --headless brownian --objects 50 --frames 5 --quiet
  --plugin "${WORK_DIR}/plugins/libmy_plugin.so" --plugin "${WORK_DIR}/plugins/libmy_engine.so"
  --engine drift --algorithm Mine --threads 3
  --json "${WORK_DIR}/results.json")

# Without a build type a plug-in is still optimised, and reports how it was built.
file(READ "${WORK_DIR}/results.json" results)
string(JSON flags GET "${results}" cases 0 conditions plugin flags)
if(NOT flags MATCHES ", optimised.*: .*-O3")
  message(FATAL_ERROR "the plug-in says that it was built with '${flags}'")
endif()

if(PYTHON)
  run("${PYTHON}" "${SOURCE_DIR}/check_links.py" "${WORK_DIR}/prefix/share/doc/broadmark")
  file(GLOB packages "${WORK_DIR}/prefix/lib/python3*/dist-packages")
  run(${CMAKE_COMMAND} -E env --unset=BROADMARK "PYTHONPATH=${packages}" "PYTHONDONTWRITEBYTECODE=1"
    "${PYTHON}" "${SOURCE_DIR}/use_python_package.py" "${WORK_DIR}/prefix")
endif()
