# Runs a program and checks how it ends: cmake -D EXIT=... [-D OUT=...] [-D ERR=...] -P expect.cmake -- PROGRAM [ARGUMENT...]
#   EXIT  the exit code
#   OUT   a regular expression that stdout must match
#   ERR   one that stderr must match; without it stderr must be empty. Whatever it is, stderr is one line, led by the program's name.
unset(ENV{DISPLAY})  # no window
unset(ENV{WAYLAND_DISPLAY})

set(command)
set(started FALSE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
    if(started)
        list(APPEND command "${CMAKE_ARGV${i}}")
    elseif(CMAKE_ARGV${i} STREQUAL "--")
        set(started TRUE)
    endif()
endforeach()

list(GET command 0 program)
get_filename_component(program ${program} NAME)
execute_process(COMMAND ${command} RESULT_VARIABLE exit OUTPUT_VARIABLE out ERROR_VARIABLE err)
message("${out}${err}")
if(NOT exit STREQUAL EXIT)
    message(FATAL_ERROR "the exit code is ${exit}, not ${EXIT}")
endif()
if(DEFINED OUT AND NOT out MATCHES "${OUT}")
    message(FATAL_ERROR "stdout does not match ${OUT}")
endif()
if(DEFINED ERR)
    if(NOT err MATCHES "^${program}: [^\n]*(${ERR})[^\n]*\n$")
        message(FATAL_ERROR "stderr is not one line that matches ${ERR}")
    endif()
elseif(NOT err STREQUAL "")
    message(FATAL_ERROR "stderr is not empty")
endif()
