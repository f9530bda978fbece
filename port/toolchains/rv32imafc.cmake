# RV32IMAFC: single precision unit.
set(GOE_TARGET_FLAGS -march=rv32imafc -mabi=ilp32f)
set(GOE_TARGET_BOARDS virt)
include(${CMAKE_CURRENT_LIST_DIR}/riscv.cmake)
