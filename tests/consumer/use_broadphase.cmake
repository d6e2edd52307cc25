# Installs the broad-phase library alone into a fresh prefix, then builds and runs its examples against
# it by CMake and by pkg-config. Arguments: BUILD_DIR, SOURCE_DIR (of the examples), WORK_DIR, COMPILER,
# C_COMPILER, STRIP, NM, LIBRARY (the shared one's file name), PKG_CONFIG, OPTIMISED (its size counts).
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()
function(read_output variable)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" output "${output}")
  list(REMOVE_ITEM output "")
  set(${variable} ${output} PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --component broadphase --prefix "${prefix}")
file(GLOB headers RELATIVE "${prefix}/include/broadmark" "${prefix}/include/broadmark/*")
if(NOT "${headers}" STREQUAL "broadphase.h;broadphase.hpp")
  message(FATAL_ERROR "other headers than the library's: ${headers}")
endif()

# Nothing but the C++ standard library, and nothing but the interface.
file(GLOB_RECURSE library "${prefix}/${LIBRARY}")
get_filename_component(folder "${library}" DIRECTORY)
run("${STRIP}" -o "${WORK_DIR}/stripped.so" "${library}")
file(SIZE "${WORK_DIR}/stripped.so" size)
message(STATUS "${size} bytes")
if(OPTIMISED AND size GREATER 400000)
  message(FATAL_ERROR "the stripped library has ${size} bytes")
endif()
read_output(linked ldd "${library}")
list(FILTER linked EXCLUDE REGEX "linux-vdso|ld-linux|libc\\.|libm\\.|libgcc_s\\.|libstdc\\+\\+\\.")
if(linked)
  message(FATAL_ERROR "the library needs ${linked}")
endif()
read_output(symbols "${NM}" -D -C --defined-only "${library}")
list(FILTER symbols EXCLUDE REGEX " (bm_[a-z_]+|broadmark::broadphase::BroadPhase::[~a-zA-Z=]+\\(.*)$")
if(symbols)
  message(FATAL_ERROR "the library exports ${symbols}")
endif()

message(STATUS "by CMake")
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${WORK_DIR}/build" "-DCMAKE_PREFIX_PATH=${prefix}"
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_C_COMPILER=${C_COMPILER}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}/build")
foreach(example game_loop game_loop_static job_system game_loop_c)
  run("${WORK_DIR}/build/${example}")
endforeach()

find_program(RUSTC rustc)
if(RUSTC)
  message(STATUS "from Rust")
  run("${RUSTC}" -O "${SOURCE_DIR}/game_loop.rs" -L "${folder}" -C "link-arg=-Wl,-rpath,${folder}"
    -o "${WORK_DIR}/example")
  run("${WORK_DIR}/example")
endif()

# Without the rest, the package says what there is.
file(WRITE "${WORK_DIR}/rest/CMakeLists.txt"
  "cmake_minimum_required(VERSION 3.16)\nproject(p CXX)\nfind_package(broadmark REQUIRED)\n")
execute_process(COMMAND ${CMAKE_COMMAND} -S "${WORK_DIR}/rest" -B "${WORK_DIR}/rest/build"
  "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${COMPILER}"
  RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE text)
if(status EQUAL 0 OR NOT text MATCHES "only its component broadphase")
  message(FATAL_ERROR "find_package(broadmark) without components: ${text}")
endif()

if(NOT PKG_CONFIG)
  message(STATUS "no pkg-config")
  return()
endif()
message(STATUS "by pkg-config")
set(ENV{PKG_CONFIG_PATH} "${folder}/pkgconfig")
foreach(example game_loop.cpp job_system.cpp game_loop.c)
  set(compile "${COMPILER}" -std=c++20)
  if(example MATCHES "\\.c$")
    set(compile "${C_COMPILER}")
  endif()
  read_output(flags "${PKG_CONFIG}" --cflags --libs broadmark-broadphase)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${compile} "${SOURCE_DIR}/${example}" -o "${WORK_DIR}/example" ${flags}
    "-Wl,-rpath,${folder}" -pthread)
  run("${WORK_DIR}/example")
endforeach()
read_output(flags "${PKG_CONFIG}" --static --libs broadmark-broadphase)
separate_arguments(flags UNIX_COMMAND "${flags}")
list(TRANSFORM flags REPLACE "^-lbroadmark-broadphase$" "-l:libbroadmark-broadphase.a")
run("${C_COMPILER}" "-I${prefix}/include" "${SOURCE_DIR}/game_loop.c" -o "${WORK_DIR}/example" ${flags})
run("${WORK_DIR}/example")
