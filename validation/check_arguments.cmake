# SPDX-License-Identifier: MIT
# Checks that PROGRAM ends with status 2 and a message on bad arguments, and with 0 on --help.
foreach(arguments IN ITEMS "--bogus" "--instances;0" "--instances;many" "--device;abacus")
    execute_process(COMMAND "${PROGRAM}" ${arguments} RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE said)
    if(NOT status EQUAL 2 OR said STREQUAL "")
        message(FATAL_ERROR "exit status ${status} instead of 2, or no message: ${PROGRAM} ${arguments} (${said})")
    endif()
endforeach()
execute_process(COMMAND "${PROGRAM}" --help RESULT_VARIABLE status OUTPUT_QUIET)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "exit status ${status} instead of 0: ${PROGRAM} --help")
endif()
