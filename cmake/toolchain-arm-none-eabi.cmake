# Shared by all Cortex-M targets; the file of the core sets CUSP_CORE_FLAGS and includes this one.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# -fno-math-errno: sqrtf is the one instruction, not a call that sets errno.
string(JOIN " " CMAKE_CXX_FLAGS_INIT ${CUSP_CORE_FLAGS} -mthumb -mfloat-abi=hard
  -ffunction-sections -fdata-sections -fno-math-errno)
# The compiler's own arithmetic, last on every link line; no C library.
set(CMAKE_CXX_STANDARD_LIBRARIES_INIT -lgcc)

# No compiler cache: it would give back objects without the call graphs that the proofs read.
set(CMAKE_CXX_COMPILER_LAUNCHER "" CACHE STRING "" FORCE)
