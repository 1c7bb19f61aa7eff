# Run at every build: writes OUTPUT from TEMPLATE with the commit and dirty flag of SOURCE, by GIT.

# Runs git in SOURCE, whoever owns the clone; `result`_KNOWN tells whether git could answer.
function(ask_git result)
  set(${result} "" PARENT_SCOPE)
  set(${result}_KNOWN OFF PARENT_SCOPE)
  if(GIT)
    execute_process(COMMAND ${GIT} -c safe.directory=* -C ${SOURCE} ${ARGN}
                    OUTPUT_VARIABLE answer ERROR_QUIET RESULT_VARIABLE status
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(status EQUAL 0)
      set(${result} "${answer}" PARENT_SCOPE)
      set(${result}_KNOWN ON PARENT_SCOPE)
    endif()
  endif()
endfunction()

set(MBS_COMMIT "unknown")
set(MBS_DIRTY "unknown")
ask_git(top rev-parse --show-toplevel)
ask_git(head rev-parse HEAD)
file(REAL_PATH ${SOURCE} source)
# An unpacked archive inside some other repository has no commit of its own.
if(head AND top STREQUAL source)
  set(MBS_COMMIT ${head})
  # Results do not go into the program, and measuring writes some.
  ask_git(changes --no-optional-locks status --porcelain -- . ":(exclude)results")
  if(changes)
    set(MBS_DIRTY "true")
  elseif(changes_KNOWN)
    set(MBS_DIRTY "false")
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
