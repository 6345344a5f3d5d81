# SPDX-License-Identifier: Apache-2.0
# Writes OUT, a header with the commit that is built, if it is another than OUT has: KAGE_COMMIT is " (1234abc)",
# " (1234abc, changed)" where tracked files differ from it, and "" where no commit is known. In an archive that
# `git archive` made, commit.txt has it.
#
# usage: cmake -D SOURCE=... -D OUT=... -P KageCommit.cmake
set(commit "")
file(STRINGS ${SOURCE}/cmake/commit.txt archived LIMIT_COUNT 1)
if(archived MATCHES "^[0-9a-f]+$")
  set(commit " (${archived})")
elseif(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short HEAD OUTPUT_VARIABLE hash RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    execute_process(COMMAND git -C ${SOURCE} diff --quiet HEAD RESULT_VARIABLE changed OUTPUT_QUIET ERROR_QUIET)
    set(commit " (${hash})")
    if(changed)
      set(commit " (${hash}, changed)")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define KAGE_COMMIT \"${commit}\"\n" @ONLY)
