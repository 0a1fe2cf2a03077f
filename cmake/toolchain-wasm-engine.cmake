# The planners in WebAssembly, with Debian's emscripten: exceptions are WebAssembly's own.
find_path(CUSP_EMSCRIPTEN cmake/Modules/Platform/Emscripten.cmake PATHS /usr/share/emscripten $ENV{EMSCRIPTEN}
  NO_DEFAULT_PATH REQUIRED)
include(${CUSP_EMSCRIPTEN}/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CXX_FLAGS_INIT -fwasm-exceptions)
