# Cortex-M0+: no floating-point unit; gcc's or clang's run-time library computes.
# QEMU has no M0+. microbit is a Cortex-M0, the same instruction set (ARMv6-M), and runs the replay; what needs more
# than its 16 KiB of RAM runs on mps2-an385, a Cortex-M3, which executes ARMv6-M code.
set(GOE_TARGET_FLAGS -mcpu=cortex-m0plus -mthumb -mfloat-abi=soft)
set(GOE_TARGET_BOARDS mps2-an385 microbit)
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
