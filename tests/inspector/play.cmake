# Plays a script in the inspector, off-screen, in a fresh directory of its own.
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
execute_process(
  COMMAND ${PROGRAM} --headless --ui --plugin ${PLUGIN} --script ${SCRIPT} --gl auto
  WORKING_DIRECTORY ${WORK_DIR} COMMAND_ERROR_IS_FATAL ANY)
