# Cortex-M33 with its single precision unit.
set(GOE_TARGET_FLAGS -mcpu=cortex-m33 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard)
set(GOE_TARGET_BOARDS mps2-an505)
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
