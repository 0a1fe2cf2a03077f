# The core in WebAssembly, for the pages of `cusp view`: a build of its own with the preset wasm.
set(CUSP_WASM AUTO CACHE STRING "The core in WebAssembly, for the pages: AUTO, ON or OFF")

# Sets `packages` (of the caller) to the Debian packages that are missing for it.
function(cusp_missing_wasm_packages)
  set(missing "")
  find_program(CUSP_WASM_COMPILER clang++-14 clang++)
  find_program(CUSP_WASM_LINKER wasm-ld-14 wasm-ld)
  find_file(CUSP_WASM_LIBC wasm32-wasi/libc.a PATHS /usr/lib NO_DEFAULT_PATH)
  find_path(CUSP_WASM_LIBCXX wasm32-wasi/c++/v1/vector PATHS /usr/include NO_DEFAULT_PATH)
  file(GLOB builtins /usr/lib/llvm-14/lib/clang/*/lib/wasi/libclang_rt.builtins-wasm32.a)
  # clang runs it on its own where it finds it: the module is the same on every machine only with it.
  find_program(CUSP_WASM_OPTIMIZER wasm-opt)
  mark_as_advanced(CUSP_WASM_COMPILER CUSP_WASM_LINKER CUSP_WASM_LIBC CUSP_WASM_LIBCXX CUSP_WASM_OPTIMIZER)
  foreach(pair clang:CUSP_WASM_COMPILER lld:CUSP_WASM_LINKER wasi-libc:CUSP_WASM_LIBC
      libc++-14-dev-wasm32:CUSP_WASM_LIBCXX libclang-rt-14-dev-wasm32:builtins binaryen:CUSP_WASM_OPTIMIZER)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 package)
    list(GET pair 1 place)
    if(NOT ${place})
      list(APPEND missing ${package})
    endif()
  endforeach()
  list(JOIN missing " " packages)
  set(packages "${packages}" PARENT_SCOPE)
endfunction()

# cusp_add_wasm_core(VARIABLE): the file that the build makes, also the global property CUSP_WASM_CORE; empty where packages
# are missing, which is said in a line.
function(cusp_add_wasm_core variable)
  set(${variable} "" PARENT_SCOPE)
  if(CUSP_WASM STREQUAL "OFF")
    return()
  endif()
  cusp_missing_wasm_packages()
  if(packages AND CUSP_WASM STREQUAL "ON")
    message(FATAL_ERROR "CUSP_WASM is ON, but these packages are missing: ${packages}")
  elseif(packages)
    message(STATUS "no core in the pages of cusp view: these packages are missing: ${packages}")
    return()
  endif()
  set(folder ${PROJECT_BINARY_DIR}/wasm)
  set(core ${folder}/bin/cusp_core.wasm)
  set(sources ${PROJECT_SOURCE_DIR}/cmake/toolchain-wasm.cmake)
  foreach(place firmware hal boards/sim host_tools/base/elementary host_tools/controller/dialect host_tools/controller/program_run host_tools/controller/wasm)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${place}/*.[hc]pp)
    list(APPEND sources ${found})
  endforeach()
  add_custom_command(OUTPUT ${core}
    COMMAND ${CMAKE_COMMAND} --preset wasm -B ${folder} > ${PROJECT_BINARY_DIR}/wasm.log
    COMMAND ${CMAKE_COMMAND} --build ${folder} >> ${PROJECT_BINARY_DIR}/wasm.log
    DEPENDS ${sources} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    COMMENT "Building the core in WebAssembly" VERBATIM)
  set_property(GLOBAL PROPERTY CUSP_WASM_CORE ${core})
  set(${variable} ${core} PARENT_SCOPE)
endfunction()
