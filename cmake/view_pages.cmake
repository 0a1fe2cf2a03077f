# Bundles the pages of host_tools/judge/view/web into OUTPUT, a C++ source that holds them. Run at build time.
# cmake -DWEB=<host_tools/judge/view/web> -DFOLDER=<build folder> -DOUTPUT=<file> -DNPM=<npm> -DNODE=<node> -DNEEDED=ON|OFF
#   -DDEVELOPMENT=ON|OFF -DBUNDLE=<host_tools/judge/view/bundle> [-DCORE=<wasm>] -P view_pages.cmake
# If npm can't fetch what package-lock.json names, NEEDED=OFF takes the bundle.

# The packages are fetched once for a lock file.
file(SHA256 ${WEB}/package-lock.json lock)
set(stamp "${lock} ${DEVELOPMENT}")
set(fetched "")
if(EXISTS ${FOLDER}/fetched.txt)
  file(READ ${FOLDER}/fetched.txt fetched)
endif()
# Files that left the tree are no longer bundled.
file(REMOVE_RECURSE ${FOLDER}/src)
file(COPY ${WEB}/ DESTINATION ${FOLDER} PATTERN node_modules EXCLUDE PATTERN out EXCLUDE)
if(NOT fetched STREQUAL stamp)
  set(omit --omit=dev)
  if(DEVELOPMENT)
    set(omit "")
  endif()
  execute_process(COMMAND ${NPM} ci ${omit} --no-progress WORKING_DIRECTORY ${FOLDER}
    RESULT_VARIABLE failed OUTPUT_FILE ${FOLDER}/npm.log ERROR_FILE ${FOLDER}/npm.log TIMEOUT 300)
  if(failed)
    if(NEEDED)
      message(FATAL_ERROR "npm ci failed: see ${FOLDER}/npm.log")
    endif()
    message("cusp view: npm could not fetch the page's libraries (${FOLDER}/npm.log): the page is ${BUNDLE}")
    set(FOLDER ${BUNDLE})
    set(HOLDS_CORE OFF)
    include(${CMAKE_CURRENT_LIST_DIR}/view_page_text.cmake)
    return()
  endif()
  file(WRITE ${FOLDER}/fetched.txt "${stamp}")
endif()
set(core "")
if(CORE)
  set(core --core ${CORE})
endif()
execute_process(COMMAND ${NODE} build.mjs --out ${FOLDER}/out ${core}
  WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the pages of cusp view could not be bundled")
endif()
set(FOLDER ${FOLDER}/out)
set(HOLDS_CORE ${CORE})
include(${CMAKE_CURRENT_LIST_DIR}/view_page_text.cmake)
