# Images: programs for a chip, without a C library, laid out by a linker script.

# cusp_image(NAME <name> SCRIPT <linker script> SOURCES <file>... DEPENDS <target>... [FIRMWARE_BIN] [UF2 <address>])
#
# Builds <name>.elf, <name>.bin, <name>.hex and <name>.map into the build's bin folder; with FIRMWARE_BIN also
# <name>/firmware.bin there, which the makers' boot loaders take from an SD card. With UF2 also <name>.uf2, for the drive
# that the boot ROM of an RP2350 shows; the image begins at that address.
function(cusp_image)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "FIRMWARE_BIN" "NAME;SCRIPT;UF2" "SOURCES;DEPENDS")
  set(out ${PROJECT_BINARY_DIR}/bin)
  set(tree ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/..)
  get_filename_component(script ${ARG_SCRIPT} ABSOLUTE)
  add_executable(${ARG_NAME} ${ARG_SOURCES})
  set_target_properties(${ARG_NAME} PROPERTIES
    SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${out}
    LINK_DEPENDS "${script};${tree}/hal/stm32f4/sections.ld;${tree}/hal/rp2350/sections.ld;${tree}/hal/cortex_m/board.ld")
  target_include_directories(${ARG_NAME} PRIVATE ${tree})
  target_link_libraries(${ARG_NAME} PRIVATE cusp_freestanding ${ARG_DEPENDS})
  # As objects, since what the compiler calls on its own is known only at the end of the link.
  target_sources(${ARG_NAME} PRIVATE $<TARGET_OBJECTS:cusp_hal_freestanding>)
  target_link_options(${ARG_NAME} PRIVATE
    -nostartfiles -nostdlib -T ${script} -L ${tree}
    -Wl,--gc-sections -Wl,--emit-relocs -Wl,-Map=${out}/${ARG_NAME}.map -Wl,--print-memory-usage)
  # Places of four numbers take more of it.
  if(CUSP_AXES EQUAL 4 AND NOT ARG_UF2)
    target_link_options(${ARG_NAME} PRIVATE -Wl,--defsym=cusp_stack_size=7168)
  endif()
  add_custom_command(TARGET ${ARG_NAME} POST_BUILD
    COMMAND ${CMAKE_OBJCOPY} -O binary --gap-fill 0xff $<TARGET_FILE:${ARG_NAME}> ${out}/${ARG_NAME}.bin
    COMMAND ${CMAKE_OBJCOPY} -O ihex $<TARGET_FILE:${ARG_NAME}> ${out}/${ARG_NAME}.hex)
  if(ARG_FIRMWARE_BIN)
    add_custom_command(TARGET ${ARG_NAME} POST_BUILD
      COMMAND ${CMAKE_COMMAND} -E make_directory ${out}/${ARG_NAME}
      COMMAND ${CMAKE_COMMAND} -E copy ${out}/${ARG_NAME}.bin ${out}/${ARG_NAME}/firmware.bin)
  endif()
  if(ARG_UF2)
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    add_custom_command(TARGET ${ARG_NAME} POST_BUILD
      COMMAND Python3::Interpreter ${tree}/cmake/uf2.py ${out}/${ARG_NAME}.bin ${ARG_UF2} ${out}/${ARG_NAME}.uf2)
  endif()
endfunction()
