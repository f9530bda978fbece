# RV32 with riscv64-unknown-elf-gcc and picolibc.

set(CMAKE_SYSTEM_PROCESSOR riscv)
set(GOE_TARGET_ENTRY port_entry)
set(GOE_TARGET_COMPILER gcc CACHE STRING "gcc")
set(GOE_QEMU qemu-system-riscv32)
set(GOE_QEMU_OPTIONS -bios none)

# there is RAM alone, from 0x80000000 on
set(GOE_BOARD_virt_MEMORY ROM_ORIGIN=0x80000000 ROM_LENGTH=0x400000 RAM_ORIGIN=0x80400000 RAM_LENGTH=0x400000
    STACK_LENGTH=0x4000)

if(NOT GOE_TARGET_COMPILER STREQUAL gcc)
    message(FATAL_ERROR "GOE_TARGET_COMPILER=${GOE_TARGET_COMPILER}: RISC-V is built with gcc alone")
endif()
find_program(GOE_RISCV_GCC riscv64-unknown-elf-gcc REQUIRED)
set(CMAKE_C_COMPILER ${GOE_RISCV_GCC})
set(GOE_TARGET_COMPILER_FLAGS --specs=picolibc.specs)

include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
