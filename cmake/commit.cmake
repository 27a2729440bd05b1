# Writes OUTPUT with the commit of SOURCE, if it has changed: run at every build, so that no program states a commit it
# was not built from.
execute_process(COMMAND git -c safe.directory=* describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define CRESCENT_COMMIT \"${commit}\"\n")
