# The core as a WebAssembly module: wasm32-wasi with Debian's clang, lld, wasi-libc, libc++ and compiler-rt.
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
find_program(CUSP_WASM_COMPILER clang++-14 clang++ REQUIRED)
set(CMAKE_CXX_COMPILER ${CUSP_WASM_COMPILER})
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# No exceptions and no tables of types: the module is loaded by a page. -fno-math-errno: sqrt is one instruction.
string(JOIN " " CMAKE_CXX_FLAGS_INIT -fno-exceptions -fno-rtti -fno-math-errno -ffunction-sections -fdata-sections)
