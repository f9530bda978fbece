# A build for the host: see CMakeLists.txt.

if(GOE_SANITIZE OR GOE_FAST_MATH)
    return()
endif()

add_executable(replay replay_main.c ${replay_sources})
goe_compile(replay)
target_link_libraries(replay PRIVATE goe)
goe_check_hash(replay replay)

find_program(BASH bash)
set(target_tests ${CMAKE_CURRENT_SOURCE_DIR})

# goe_target_test(<name> <seconds> <script> <argument>...): status 77 of a script means that something is not installed
function(goe_target_test name seconds script)
    add_test(NAME ${name} COMMAND ${BASH} ${target_tests}/${script} ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS targets SKIP_RETURN_CODE 77 TIMEOUT ${seconds})
endfunction()

goe_target_test(replay_every_host_build 900 host_builds.sh ${golden})
goe_target_test(self_check_host 900 host_self_check.sh ${golden})

# ------------------------------------------------------------------------------------------------- one test each target

# Unit tests of tests/c on the builds with gcc -O2; the others run the replay, its stack and the self-check's proofs.
set(unity_dir "")
if(TARGET goe_unity)
    get_target_property(unity_dir goe_unity INTERFACE_INCLUDE_DIRECTORIES)
endif()
foreach(processor m0plus m4f m7-sp m7-dp m33 m55 rv32imac rv32imafc)
    foreach(compiler gcc clang)
        if(compiler STREQUAL clang AND processor MATCHES rv32)
            continue()
        endif()
        foreach(level os o2)
            set(units OFF)
            if(compiler STREQUAL gcc AND level STREQUAL o2 AND unity_dir)
                set(units ON)
            endif()
            goe_target_test(target_${processor}-${compiler}-${level} 1800 build_target.sh
                ${processor}-${compiler}-${level} ${CMAKE_CURRENT_BINARY_DIR} ${units} "${unity_dir}")
        endforeach()
    endforeach()
endforeach()
