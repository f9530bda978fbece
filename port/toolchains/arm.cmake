# Cortex-M with arm-none-eabi-gcc and its newlib, or with clang and that same C library and linker.

set(CMAKE_SYSTEM_PROCESSOR arm)
set(GOE_TARGET_ENTRY port_start)
set(GOE_TARGET_COMPILER gcc CACHE STRING "gcc or clang")
set(GOE_QEMU qemu-system-arm)
set(GOE_QEMU_OPTIONS "")

# origin and length of ROM and RAM in bytes, and of the stack at the RAM's end
set(GOE_BOARD_mps2-an385_MEMORY ROM_ORIGIN=0 ROM_LENGTH=0x400000 RAM_ORIGIN=0x20000000 RAM_LENGTH=0x400000
    STACK_LENGTH=0x4000)
set(GOE_BOARD_mps2-an386_MEMORY ${GOE_BOARD_mps2-an385_MEMORY})
set(GOE_BOARD_mps2-an500_MEMORY ${GOE_BOARD_mps2-an385_MEMORY})
set(GOE_BOARD_mps2-an505_MEMORY ROM_ORIGIN=0x10000000 ROM_LENGTH=0x400000 RAM_ORIGIN=0x38000000 RAM_LENGTH=0x200000
    STACK_LENGTH=0x4000)
set(GOE_BOARD_mps3-an547_MEMORY ROM_ORIGIN=0 ROM_LENGTH=0x80000 RAM_ORIGIN=0x20000000 RAM_LENGTH=0x80000
    STACK_LENGTH=0x4000)
set(GOE_BOARD_microbit_MEMORY ROM_ORIGIN=0 ROM_LENGTH=0x40000 RAM_ORIGIN=0x20000000 RAM_LENGTH=0x4000
    STACK_LENGTH=0x1000)

find_program(GOE_ARM_GCC arm-none-eabi-gcc REQUIRED)
if(GOE_TARGET_COMPILER STREQUAL clang)
    find_program(GOE_CLANG NAMES clang-19 clang REQUIRED)
    set(CMAKE_C_COMPILER ${GOE_CLANG})
    set(CMAKE_C_COMPILER_TARGET arm-none-eabi)
    execute_process(COMMAND ${GOE_ARM_GCC} -x c -E -v /dev/null ERROR_VARIABLE search OUTPUT_QUIET)
    string(REGEX MATCH "\n (/[^\n]*/arm-none-eabi/include)\n" found "${search}")
    set(GOE_TARGET_COMPILER_FLAGS -isystem ${CMAKE_MATCH_1} -fshort-enums)
    # gcc links: it knows the C library and the run-time library of each processor
    string(JOIN " " link ${GOE_ARM_GCC} ${GOE_TARGET_FLAGS})
    set(CMAKE_C_LINK_EXECUTABLE "${link} <LINK_FLAGS> <OBJECTS> -o <TARGET> <LINK_LIBRARIES>")
else()
    set(CMAKE_C_COMPILER ${GOE_ARM_GCC})
endif()

include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
