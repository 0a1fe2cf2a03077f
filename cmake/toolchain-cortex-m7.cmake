# STM32F7- and H7-class target: Cortex-M7 with the double-precision FPU.
set(CMAKE_SYSTEM_PROCESSOR cortex-m7)
set(CUSP_CORE_FLAGS -mcpu=cortex-m7 -mfpu=fpv5-d16)
include(${CMAKE_CURRENT_LIST_DIR}/toolchain-arm-none-eabi.cmake)
