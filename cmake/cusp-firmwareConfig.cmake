# find_package(cusp-firmware): the firmware for a board that lives outside this tree, from the installed sources
# or from a checkout (-Dcusp-firmware_DIR=CHECKOUT/cmake). Afterwards there is cusp_board(); CuspBoard.cmake.
set(cusp_firmware_tree ${CMAKE_CURRENT_LIST_DIR}/..)
if(NOT CMAKE_SYSTEM_NAME STREQUAL "Generic")
  get_filename_component(cusp_firmware_toolchain ${CMAKE_CURRENT_LIST_DIR}/toolchain-cortex-m4f.cmake ABSOLUTE)
  message(FATAL_ERROR "cusp-firmware makes images for a chip: -DCMAKE_TOOLCHAIN_FILE=${cusp_firmware_toolchain}")
endif()
# As the boards of the tree are compiled: assertions stay.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g")
if(NOT TARGET cusp_app)
  set(CUSP_BOARDS "")
  add_subdirectory(${cusp_firmware_tree} ${CMAKE_BINARY_DIR}/cusp-firmware EXCLUDE_FROM_ALL)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/CuspImage.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/CuspBoard.cmake)
