# RV32IMAC: no floating-point unit; gcc's run-time library computes.
set(GOE_TARGET_FLAGS -march=rv32imac -mabi=ilp32)
set(GOE_TARGET_BOARDS virt)
include(${CMAKE_CURRENT_LIST_DIR}/riscv.cmake)
