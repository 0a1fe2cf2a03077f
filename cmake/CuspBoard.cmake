# Boards outside the tree: an image and its README from a table alone.

# The README is written by a program of the host.
find_program(CUSP_HOST_COMPILER NAMES c++ g++ clang++)

# cusp_board(NAME <name> CHIP <stm32f405|stm32f407|stm32f411|stm32f429|stm32f446> TABLE <header>)
#
# The header's first struct, in namespace cusp::boards, is the table: boards/mill3/chip_traits.hpp says what it has.
# Builds bin/<name>.elf, .bin, .hex and, beside them, <name>.md: wiring and flashing, from the table.
function(cusp_board)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "NAME;CHIP;TABLE" "")
  set(scripts stm32f405 mill3_f405/stm32f405 stm32f407 skr2_f407/stm32f407 stm32f411 black_pill_f411/stm32f411
    stm32f429 skr2_f407/stm32f407 stm32f446 octopus_f446/stm32f446ze)
  list(FIND scripts "${ARG_CHIP}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "cusp_board: CHIP ${ARG_CHIP} is none of stm32f405, stm32f407, stm32f411, stm32f429, stm32f446")
  endif()
  math(EXPR place "${place} + 1")
  list(GET scripts ${place} script)
  set(tree ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/..)
  get_filename_component(header ${ARG_TABLE} ABSOLUTE)
  file(STRINGS ${header} structs REGEX "^struct [A-Za-z0-9_]+ *{")
  if(NOT structs)
    message(FATAL_ERROR "cusp_board: ${header} has no struct")
  endif()
  list(GET structs 0 table)
  string(REGEX REPLACE "^struct ([A-Za-z0-9_]+).*" "\\1" table "${table}")
  string(TOUPPER ${ARG_CHIP} chip)
  set(name ${ARG_NAME})
  foreach(file board_main board_readme)
    configure_file(${tree}/boards/mill3/${file}.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${name}_${file}.cpp @ONLY)
  endforeach()
  cusp_image(NAME ${name} SCRIPT ${tree}/boards/${script}.ld SOURCES ${CMAKE_CURRENT_BINARY_DIR}/${name}_board_main.cpp
    DEPENDS cusp::app cusp::hal_stm32f4)
  set(page ${PROJECT_BINARY_DIR}/bin/${name}.md)
  set(writer ${CMAKE_CURRENT_BINARY_DIR}/${name}_board_readme)
  add_custom_command(OUTPUT ${page}
    COMMAND ${CUSP_HOST_COMPILER} -std=c++17 -DCUSP_AXES=${CUSP_AXES} -I${tree} -o ${writer} ${writer}.cpp
    COMMAND ${writer} > ${page}
    DEPENDS ${header} ${writer}.cpp ${tree}/boards/mill3/board_page.hpp
    COMMENT "Writing ${name}.md from the table" VERBATIM)
  add_custom_target(${name}_page ALL DEPENDS ${page})
endfunction()
