# SPDX-License-Identifier: MIT
# Runs every sixth case of cull_gl by 1 and 8 threads, and in OpenGL ES: what it prints, with the hashes of all
# bytes, must be the same.
foreach(way "430;1" "430;8" "310;8")
    list(GET way 0 glsl)
    list(GET way 1 threads)
    set(ENV{LP_NUM_THREADS} ${threads})  # llvmpipe reads it
    execute_process(COMMAND ${program} ${glsl} 0 6 OUTPUT_VARIABLE said RESULT_VARIABLE result)
    if(NOT result EQUAL 0 OR NOT said MATCHES "bytes of case")
        message(FATAL_ERROR "GLSL ${glsl}, ${threads} threads: ${result}\n${said}")
    elseif(DEFINED before AND NOT said STREQUAL before)
        message(FATAL_ERROR "GLSL ${glsl}, ${threads} threads leave other bytes:\n${before}\n${said}")
    endif()
    set(before "${said}")
endforeach()
