# What the toolchain files of this folder share. Each of them sets
#   GOE_TARGET_FLAGS    the processor's compiler flags
#   GOE_TARGET_BOARDS   boards of QEMU that images are made for; the first serves all, the others only what fits
# and includes arm.cmake or riscv.cmake, which include this file at their end.
#
# -DGOE_TARGET_COMPILER=gcc|clang chooses the compiler.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES GOE_TARGET_COMPILER)

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

string(JOIN " " CMAKE_C_FLAGS_INIT ${GOE_TARGET_FLAGS} ${GOE_TARGET_COMPILER_FLAGS})
set(CMAKE_C_FLAGS_RELEASE_INIT "")
set(CMAKE_C_FLAGS_RELEASE "" CACHE STRING "Optimization: -Os or -O2")

# The command that runs an image: goe_qemu_<board>.
foreach(board IN LISTS GOE_TARGET_BOARDS)
    set(goe_qemu_${board} ${GOE_QEMU} -M ${board} -nographic -monitor none -serial none
        -semihosting-config enable=on,target=native ${GOE_QEMU_OPTIONS} -kernel)
endforeach()
list(GET GOE_TARGET_BOARDS 0 GOE_TARGET_BOARD)
set(CMAKE_CROSSCOMPILING_EMULATOR ${goe_qemu_${GOE_TARGET_BOARD}})

# Read by tools/ci/cost.
set(GOE_TARGET_BOARD ${GOE_TARGET_BOARD} CACHE INTERNAL "Board that the ledger is measured on")
set(GOE_QEMU_COMMAND "${CMAKE_CROSSCOMPILING_EMULATOR}" CACHE INTERNAL "Command that runs an image on it")
