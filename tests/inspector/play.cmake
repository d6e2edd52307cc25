# Plays a script in the inspector, off-screen, in a fresh directory of its own. Comments of the
# script may tell what belongs to it; STATUS is what a command has to end with, PLUGIN in its
# environment is the library of the faulty algorithms (UNRULY, UNRULY_ENGINE: the
# algorithm and the engine that crash or hang when asked to):
#   # before STATUS: COMMAND
#   # arguments: further ones of the program
#   # after STATUS: COMMAND
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
get_filename_component(program_directory ${PROGRAM} DIRECTORY)
set(ENV{PATH} "${program_directory}:$ENV{PATH}")
set(ENV{PLUGIN} ${PLUGIN})

function(run_commands when)
  file(STRINGS ${SCRIPT} lines REGEX "^# ${when} [0-9]+: ")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "^# ${when} ([0-9]+): (.*)" ignored "${line}")
    set(wanted ${CMAKE_MATCH_1})
    set(command "${CMAKE_MATCH_2}")
    execute_process(COMMAND sh -c "${command}" WORKING_DIRECTORY ${WORK_DIR}
      RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL wanted)
      message(FATAL_ERROR "${command}\nended with ${status}, not ${wanted}:\n${output}")
    endif()
  endforeach()
endfunction()

run_commands(before)
file(STRINGS ${SCRIPT} arguments REGEX "^# arguments: ")
string(REPLACE "# arguments: " "" arguments "${arguments}")
separate_arguments(arguments UNIX_COMMAND "${arguments}")
execute_process(
  COMMAND ${PROGRAM} --headless --ui ${arguments} --plugin ${PLUGIN}
    --plugin ${UNRULY} --plugin ${UNRULY_ENGINE} --script ${SCRIPT} --gl auto
  WORKING_DIRECTORY ${WORK_DIR} COMMAND_ERROR_IS_FATAL ANY)
run_commands(after)
