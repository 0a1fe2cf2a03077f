# Writes build_version.hpp: the commit that is built. Run at each build, and the file changes only where the commit does.
# cmake -DSOURCE=<tree> -DOUTPUT=<file> -P build_version.cmake
set(commit "")
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -c safe.directory=* -C ${SOURCE} describe --always --dirty=+ --abbrev=10 --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(commit STREQUAL "")
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"// Made at each build by cmake/build_version.cmake.
#pragma once

#define CUSP_COMMIT \"@commit@\"
" @ONLY)
