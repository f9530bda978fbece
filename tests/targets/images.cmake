# A build for a target: see CMakeLists.txt.

set(GOE_TARGET_TESTS all CACHE STRING "Tests of tests/c to build as images, too: all, safety, none")
set_property(CACHE GOE_TARGET_TESTS PROPERTY STRINGS all safety none)

add_subdirectory(${PROJECT_SOURCE_DIR}/port/baremetal baremetal)

target_link_libraries(goe PUBLIC m)
# Read by tools/ci/cost. Line information (-g1) does not change the code; on the processor for which the cost is proved.
target_compile_options(goe PRIVATE -ffunction-sections -fstack-usage $<$<C_COMPILER_ID:GNU>:-fcallgraph-info=su>)
if(GOE_TARGET_BOARD STREQUAL mps2-an386)
    target_compile_options(goe PRIVATE $<$<C_COMPILER_ID:GNU>:-g1>)
endif()

# The embedded logs and their replay, compiled once for all images.
add_library(replay_parts OBJECT ${replay_sources})
goe_compile(replay_parts)
target_link_libraries(replay_parts PRIVATE goe goe_port)

# goe_image(<target> <board> <source>...): an image for a board, without the library
function(goe_image target board)
    add_executable(${target} ${ARGN})
    goe_compile(${target})
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/lib)
    target_link_libraries(${target} PRIVATE goe_port goe_board_${board})
    set_target_properties(${target} PROPERTIES CROSSCOMPILING_EMULATOR "${goe_qemu_${board}}")
endfunction()

# ------------------------------------------------------------------------------------------------- replay and its stack

foreach(board IN LISTS GOE_TARGET_BOARDS)
    goe_image(replay_${board} ${board} replay_main.c $<TARGET_OBJECTS:replay_parts>)
    target_link_libraries(replay_${board} PRIVATE goe)
    target_link_options(replay_${board} PRIVATE LINKER:-Map,${CMAKE_CURRENT_BINARY_DIR}/replay_${board}.map)
    goe_check_hash(replay_${board} replay_${board})

    goe_image(stack_${board} ${board} stack_main.c $<TARGET_OBJECTS:replay_parts>)
    target_link_libraries(stack_${board} PRIVATE goe)
    add_test(NAME stack_${board} COMMAND stack_${board})
    set_tests_properties(stack_${board} PROPERTIES LABELS targets TIMEOUT ${goe_hang_s}
        PASS_REGULAR_EXPRESSION "stack goe_update [1-9][0-9]*\n")
endforeach()

# The flight layer, only on the larger board if there are two: four obstacles do not fit into 16 KiB.
goe_image(flight_${GOE_TARGET_BOARD} ${GOE_TARGET_BOARD} flight_main.c $<TARGET_OBJECTS:replay_parts>)
target_link_libraries(flight_${GOE_TARGET_BOARD} PRIVATE goe_flight)
goe_check_flight_hash(flight_${GOE_TARGET_BOARD} flight_${GOE_TARGET_BOARD})

# ---------------------------------------------------------------------------------------------------------- self-check

find_program(BASH bash)
goe_library_sources(library_sources)
set(self_check_source ${library_sources})
list(FILTER self_check_source INCLUDE REGEX "/goe_self_check\\.c$")

# goe_library_with(<name> <sources> <flag>...): compiles sources of the library again, with other projects' flags after its own
function(goe_library_with name sources)
    add_library(${name} STATIC ${sources})
    set_target_properties(${name} PROPERTIES C_STANDARD 99 C_EXTENSIONS ON)
    target_compile_options(${name} PRIVATE -ffp-contract=off -fno-math-errno ${ARGN})
    target_compile_definitions(${name} PUBLIC GOE_WINDOW_MAX=${GOE_WINDOW_MAX})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/lib)
    target_link_libraries(${name} PUBLIC m)
endfunction()

# goe_self_check_image(<image> <expected bits> <allowed bits> <mode> <definition>...)
function(goe_self_check_image image expected allowed mode)
    goe_image(${image} ${GOE_TARGET_BOARD} self_check_main.c $<TARGET_OBJECTS:replay_parts>)
    set_target_properties(${image} PROPERTIES C_EXTENSIONS ON)
    target_compile_definitions(${image} PRIVATE EXPECTED=${expected} ALLOWED=${allowed} MODE=MODE_${mode} ${ARGN})
endfunction()

# goe_self_check_proof(<name> <expected bits> <allowed bits> <mode> <flag>...): the self-check, compiled and run in this way,
# must report it. gcc at -O2 uses every flag on every processor. Others may not: then the whole library with
# these flags must give the golden hash; its image is built if the self-check has reported nothing.
function(goe_self_check_proof name expected allowed mode)
    set(image self_check_${name})
    goe_self_check_image(${image} ${expected} ${allowed} ${mode})
    set(command ${image})
    if(ARGN)
        goe_library_with(goe_${name} "${self_check_source}" ${ARGN})
        target_link_libraries(${image} PRIVATE goe_${name})
        if(NOT (CMAKE_C_COMPILER_ID STREQUAL GNU AND CMAKE_C_FLAGS_RELEASE STREQUAL -O2))
            goe_self_check_image(whole_${name} ${expected} ${allowed} ${mode} GOLDEN=0x${golden}u)
            goe_library_with(goe_whole_${name} "${library_sources}" ${ARGN})
            target_link_libraries(whole_${name} PRIVATE goe_whole_${name} goe)
            set_target_properties(whole_${name} goe_whole_${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
            set(command ${BASH} ${CMAKE_CURRENT_SOURCE_DIR}/self_check.sh ${PROJECT_BINARY_DIR} $<TARGET_FILE:${image}>
                whole_${name} $<TARGET_FILE:whole_${name}> ${goe_qemu_${GOE_TARGET_BOARD}})
        endif()
    endif()
    target_link_libraries(${image} PRIVATE goe) # sources not in the list above
    add_test(NAME ${image} COMMAND ${command})
    set_tests_properties(${image} PROPERTIES LABELS targets TIMEOUT ${goe_hang_s})
endfunction()

set(contracted 0x01u)
set(reassociated 0x02u)
set(reciprocal 0x04u)
set(flushed 0x08u)
set(rounding 0x20u)
set(any 0x3Fu)
string(REGEX MATCH "-mfpu=|-mcpu=cortex-m55|rv32[a-z]*f" has_fpu "${GOE_TARGET_FLAGS}")

goe_self_check_proof(plain 0u 0u NONE)
goe_self_check_proof(reciprocal ${reciprocal} 0u NONE -freciprocal-math)
goe_self_check_proof(fast_math ${reassociated} ${any} NONE -ffast-math)
if(has_fpu)
    goe_self_check_proof(contracted ${contracted} 0u NONE -ffp-contract=fast)
    goe_self_check_proof(round_up ${rounding} ${any} UP)
    goe_self_check_proof(round_down ${rounding} ${any} DOWN)
    goe_self_check_proof(round_to_zero ${rounding} ${any} TO_ZERO)
    if(CMAKE_SYSTEM_PROCESSOR STREQUAL arm) # RISC-V has no such mode
        goe_self_check_proof(flushed ${flushed} 0u FLUSH)
        if(GOE_TARGET_FLAGS MATCHES nomve.fp)
            goe_self_check_proof(helium ${flushed} 0u NONE -mcpu=cortex-m55)
        endif()
    endif()
endif()

# ------------------------------------------------------------------------------------------------------- square root

# The square root of port/sqrtf in integers against the C library's, which the replay has just shown to be right.
if(NOT has_fpu)
    goe_image(sqrtf ${GOE_TARGET_BOARD} ${PROJECT_SOURCE_DIR}/tests/rtos/sqrtf_main.c
        ${PROJECT_SOURCE_DIR}/port/sqrtf/goe_sqrtf.c)
    target_include_directories(sqrtf PRIVATE ${PROJECT_SOURCE_DIR}/port/sqrtf)
    target_compile_definitions(sqrtf PRIVATE DENSE=1009u SPARSE=99991u)
    add_test(NAME sqrtf COMMAND sqrtf)
    set_tests_properties(sqrtf PROPERTIES LABELS targets TIMEOUT ${goe_hang_s} PASS_REGULAR_EXPRESSION "^every root is right\n")
endif()

# ---------------------------------------------------------------------------------------------------------- unit tests

# All of tests/c except test_host_*.c and test_double_*.c: the latter compare the library with double precision at length,
# which single precision processors emulate. Or only the safety tests: random bit patterns as input.
if(NOT GOE_TARGET_TESTS STREQUAL none)
    include(${PROJECT_SOURCE_DIR}/port/cmake/unity.cmake)
    if(NOT TARGET goe_unity)
        message(FATAL_ERROR "Images need the sources of Unity: name them with -DUNITY_DIR=")
    endif()
    target_compile_definitions(goe_unity PUBLIC UNITY_OUTPUT_CHAR=port_write_char
        "UNITY_OUTPUT_CHAR_HEADER_DECLARATION=port_write_char(char)")

    set(unit_tests ${PROJECT_SOURCE_DIR}/tests/c)
    file(GLOB programs CONFIGURE_DEPENDS ${unit_tests}/test_*.c)
    file(GLOB support CONFIGURE_DEPENDS ${unit_tests}/*.c)
    list(REMOVE_ITEM support ${programs})
    list(FILTER programs EXCLUDE REGEX "/test_(host|double)_")
    if(GOE_TARGET_TESTS STREQUAL safety)
        list(FILTER programs INCLUDE REGEX "/test_safety")
    endif()

    add_library(unit_test_support STATIC ${support})
    goe_compile(unit_test_support)
    target_compile_options(unit_test_support PRIVATE -Wno-double-promotion -Wno-float-equal)
    target_include_directories(unit_test_support PUBLIC ${unit_tests})
    target_link_libraries(unit_test_support PUBLIC goe goe_unity goe_port)
    foreach(source IN LISTS programs)
        get_filename_component(name ${source} NAME_WE)
        goe_image(${name} ${GOE_TARGET_BOARD} ${source})
        target_compile_options(${name} PRIVATE -Wno-double-promotion -Wno-float-equal)
        target_link_libraries(${name} PRIVATE unit_test_support)
        add_test(NAME ${name} COMMAND ${name})
        set_tests_properties(${name} PROPERTIES LABELS unit TIMEOUT ${goe_hang_s})
    endforeach()

    # The safety test of the flight layer.
    set(flight_tests ${PROJECT_SOURCE_DIR}/tests/flight)
    goe_image(test_flight_safety ${GOE_TARGET_BOARD} ${flight_tests}/test_flight_safety.c ${flight_tests}/flown.c)
    target_compile_options(test_flight_safety PRIVATE -Wno-double-promotion -Wno-float-equal)
    target_include_directories(test_flight_safety PRIVATE ${flight_tests})
    target_link_libraries(test_flight_safety PRIVATE unit_test_support goe_flight)
    add_test(NAME test_flight_safety COMMAND test_flight_safety)
    set_tests_properties(test_flight_safety PROPERTIES LABELS unit TIMEOUT ${goe_hang_s})
    # The safety tests of the MAVLink messages: other alignment, other pointers.
    set(mavlink_tests ${PROJECT_SOURCE_DIR}/tests/mavlink)
    foreach(name IN ITEMS test_mavlink_safety test_mavlink_codec)
        goe_image(${name} ${GOE_TARGET_BOARD} ${mavlink_tests}/${name}.c ${mavlink_tests}/any_message.c)
        target_compile_options(${name} PRIVATE -Wno-double-promotion -Wno-float-equal)
        target_include_directories(${name} PRIVATE ${mavlink_tests})
        target_link_libraries(${name} PRIVATE unit_test_support goe_mavlink)
        add_test(NAME ${name} COMMAND ${name})
        set_tests_properties(${name} PROPERTIES LABELS unit TIMEOUT ${goe_hang_s})
    endforeach()

    if(GOE_TARGET_TESTS STREQUAL all)
        add_subdirectory(${PROJECT_SOURCE_DIR}/tests/examples examples)
    endif()

    # The safety tests, with the library under the flags of four firmwares, on their processors: Cortex-M4 and M7.
    if(GOE_TARGET_FLAGS MATCHES "cortex-m[47]" AND has_fpu AND CMAKE_C_COMPILER_ID STREQUAL GNU
       AND CMAKE_C_FLAGS_RELEASE STREQUAL -O2)
        set(px4 -std=gnu11 -freciprocal-math -fno-signed-zeros -fno-trapping-math -fno-math-errno)
        set(ardupilot -std=gnu11 -fsingle-precision-constant -DNDEBUG -ffp-contract=fast)
        set(betaflight -std=gnu17 -Ofast -ffast-math -ffp-contract=fast)
        set(inav -std=gnu11 -fsingle-precision-constant -ffp-contract=fast)
        foreach(firmware px4 ardupilot betaflight inav)
            goe_library_with(goe_${firmware} "${library_sources}" ${${firmware}})
            goe_image(safety_${firmware} ${GOE_TARGET_BOARD} ${unit_tests}/test_safety.c ${support})
            target_compile_options(safety_${firmware} PRIVATE -Wno-double-promotion -Wno-float-equal)
            target_include_directories(safety_${firmware} PRIVATE ${unit_tests})
            target_link_libraries(safety_${firmware} PRIVATE goe_${firmware} goe_unity)
            add_test(NAME safety_${firmware} COMMAND safety_${firmware})
            set_tests_properties(safety_${firmware} PROPERTIES LABELS "unit;safety" TIMEOUT ${goe_hang_s})
        endforeach()
    endif()
endif()
