# A build for the host: see CMakeLists.txt.

if(GOE_SANITIZE OR GOE_FAST_MATH)
    return()
endif()

add_executable(replay replay_main.c ${replay_sources})
goe_compile(replay)
target_link_libraries(replay PRIVATE goe)
goe_check_hash(replay replay)

add_executable(flight_replay flight_main.c ${replay_sources})
goe_compile(flight_replay)
target_link_libraries(flight_replay PRIVATE goe_flight)
goe_check_flight_hash(flight_replay flight_replay)

find_program(BASH bash)
set(target_tests ${CMAKE_CURRENT_SOURCE_DIR})

# goe_target_test(<name> <script> <argument>...): a script's status 77 means that something is not installed
function(goe_target_test name script)
    add_test(NAME ${name} COMMAND ${BASH} ${target_tests}/${script} ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS targets SKIP_RETURN_CODE 77 TIMEOUT ${goe_build_hang_s})
endfunction()

# [A13]
goe_target_test(replay_host_builds host_builds.sh ${golden} ${flight_golden})
# [GOE_SELF_CONTRACTED, GOE_SELF_EXCESS, GOE_SELF_FLUSHED, GOE_SELF_REASSOCIATED, GOE_SELF_RECIPROCAL, goe_self_check]
goe_target_test(self_check_host host_self_check.sh ${golden})

# ------------------------------------------------------------------------------------------------- one test each target

# Every target runs the replay, its stack, the self-check's proofs and the safety tests of tests/c. One runs all of tests/c with
# GOE_LONG=1: README.md says why this one. COST: the longest start first.
set(target_with_all_tests m4f-gcc-o2)
# Between releases these run: the ledger's three targets, and one of each kind of floating-point arithmetic; gcc and clang, -Os and -O2.
# The others have the label release: tools/test.sh leaves them out, and the evidence of a release runs them.
set(targets_of_every_run m0plus-gcc-os m4f-gcc-os m4f-gcc-o2 m7-dp-clang-os m55-clang-o2 rv32imafc-gcc-o2)
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
            set(preset ${processor}-${compiler}-${level})
            if(NOT unity_dir)
                set(tests none)
            elseif(preset STREQUAL target_with_all_tests)
                set(tests all)
            else()
                set(tests safety)
            endif()
            goe_target_test(target_${preset} build_target.sh
                ${preset} ${CMAKE_CURRENT_BINARY_DIR} ${tests} "${unity_dir}")
            if(NOT preset IN_LIST targets_of_every_run)
                set_tests_properties(target_${preset} PROPERTIES LABELS "targets;release")
            endif()
            if(tests STREQUAL all)
                set_tests_properties(target_${preset} PROPERTIES COST 100)
            elseif(preset MATCHES "-gcc-o2")
                set_tests_properties(target_${preset} PROPERTIES COST 50)
            endif()
        endforeach()
    endforeach()
endforeach()
