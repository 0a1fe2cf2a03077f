# The files that `cmake --install` puts beside the programs, and the Debian packages that `cpack` makes of it all:
# cusp_<version>_<architecture>.deb, cusp-dev_... and python3-cusp_...
#
# The preset `package` switches on what belongs into them: Open CASCADE, Eigen, the boards' images, the man pages.

set(packaging ${PROJECT_SOURCE_DIR}/packaging)

set(data ${CMAKE_INSTALL_DATADIR})
install(DIRECTORY examples DESTINATION ${data}/cusp USE_SOURCE_PERMISSIONS COMPONENT program)
install(DIRECTORY materials posts tool_libraries DESTINATION ${data}/cusp COMPONENT program)
install(FILES studio/studio.html DESTINATION ${data}/cusp/studio COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${data}/doc/cusp COMPONENT program)
install(DIRECTORY docs DESTINATION ${data}/doc/cusp COMPONENT program)
install(FILES ${packaging}/cusp-studio.desktop DESTINATION ${data}/applications COMPONENT program)
install(FILES ${packaging}/cusp.bash DESTINATION ${data}/bash-completion/completions RENAME cusp COMPONENT program)

# The images, each with its board's README: of all presets that name boards, as the tests run them.
if(CUSP_IMAGES)
  set(commands "")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CMakePresets.json)
  file(READ ${PROJECT_SOURCE_DIR}/CMakePresets.json presets)
  string(JSON count LENGTH "${presets}" configurePresets)
  math(EXPR last "${count} - 1")
  foreach(k RANGE ${last})
    string(JSON boards ERROR_VARIABLE no_boards GET "${presets}" configurePresets ${k} cacheVariables CUSP_BOARDS)
    if(no_boards)
      continue()
    endif()
    string(JSON preset GET "${presets}" configurePresets ${k} name)
    list(APPEND commands COMMAND ${CMAKE_COMMAND} --preset ${preset} >> ${PROJECT_BINARY_DIR}/images.log
      COMMAND ${CMAKE_COMMAND} --build --preset ${preset} >> ${PROJECT_BINARY_DIR}/images.log)
    foreach(board IN LISTS boards)
      set(image ${PROJECT_SOURCE_DIR}/build/${preset}/bin/${board})
      set(folder ${data}/cusp/boards/${board})
      install(FILES boards/${board}/README.md ${image}.bin ${image}.hex DESTINATION ${folder} COMPONENT program)
      install(FILES ${image}.uf2 DESTINATION ${folder} COMPONENT program OPTIONAL)
    endforeach()
  endforeach()
  add_custom_target(cusp_images ALL ${commands}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Cross-building the images of the boards" VERBATIM)
endif()

# One page a command, and one of the program.
if(CUSP_MAN_PAGES)
  set(pages ${PROJECT_BINARY_DIR}/man)
  add_custom_target(cusp_man_pages ALL
    COMMAND sh ${packaging}/man_pages.sh $<TARGET_FILE:cusp> ${CUSP_PROGRAM_help2man} ${PROJECT_VERSION} ${pages}
    COMMENT "Making the man pages" VERBATIM)
  add_dependencies(cusp_man_pages cusp)
  install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cusp)
set(CPACK_PACKAGE_VENDOR "cusp")
set(CPACK_PACKAGE_CONTACT "The cusp developers <cusp@cusp.example>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(CUSP_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME cusp)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "cusp plans tool paths over NURBS surfaces, meshes and STEP models with a
computed bound on gouge and scallop, runs the G-code through the motion core
of its own controller firmware, cuts the part in memory and streams programs
to Grbl-compatible controllers. The firmware images of all boards come with it.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME cusp-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, static libraries and the CMake package (find_package(cusp)) of the
freestanding core that cusp simulates: G-code, planner, interpolator, pulses.
For a board of one's own. Programs that plan, verify and simulate link
cusp::plan, cusp::verify and cusp::simulate.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "lib3mf-dev, libfmt-dev, libharfbuzz-dev, libpugixml-dev, libtbb-dev, nlohmann-json3-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-cusp)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS cusp)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "cusp for Python: plan, verify and simulate tool paths
Plans a job file to G-code with computed bounds, cuts the stock in memory to
verify a program, and runs it on the core of the controller's firmware. Moves
and set points are numpy arrays. STEP and IGES need the package cusp.")

# Debian wants the licence and a changelog in each package.
set(packages program:cusp development:cusp-dev)
if(CUSP_PYTHON)
  list(APPEND packages python:python3-cusp)
endif()
foreach(pair IN LISTS packages)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  set(folder ${PROJECT_BINARY_DIR}/packaging/${package})
  configure_file(${packaging}/copyright ${folder}/copyright COPYONLY)
  configure_file(${packaging}/debian_changelog.in ${folder}/changelog @ONLY)
  add_custom_command(OUTPUT ${folder}/changelog.gz
    COMMAND gzip -9nk -f ${folder}/changelog DEPENDS ${folder}/changelog VERBATIM)
  add_custom_target(${component}_changelog ALL DEPENDS ${folder}/changelog.gz)
  install(FILES ${folder}/copyright ${folder}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT ${component})
endforeach()
include(CPack)
