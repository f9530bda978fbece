# Cortex-M55 with its floating-point unit and integer Helium.
# Without +nomve.fp a compiler may vectorise float loops; Helium flushes subnormal floats to zero, whatever FPSCR says.
set(GOE_TARGET_FLAGS -mcpu=cortex-m55+nomve.fp -mthumb -mfloat-abi=hard)
set(GOE_TARGET_BOARDS mps3-an547)
include(${CMAKE_CURRENT_LIST_DIR}/arm.cmake)
