# Cortex-M4 with its single precision unit.
set(GOE_TARGET_FLAGS -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard)
set(GOE_TARGET_BOARDS mps2-an386)
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
