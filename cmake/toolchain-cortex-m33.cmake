# RP2350-class target: Cortex-M33 with the single-precision FPU.
set(CMAKE_SYSTEM_PROCESSOR cortex-m33)
set(CUSP_CORE_FLAGS -mcpu=cortex-m33 -mfpu=fpv5-sp-d16)
include(${CMAKE_CURRENT_LIST_DIR}/toolchain-arm-none-eabi.cmake)
