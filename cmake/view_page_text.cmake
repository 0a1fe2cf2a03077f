# Writes OUTPUT, a C++ source that holds the pages of cusp view which lie in FOLDER.
# cmake -DFOLDER=<view.html, studio.html and perhaps playground.html> -DHOLDS_CORE=ON|OFF -DOUTPUT=<file> -P view_page_text.cmake
foreach(page view playground studio)
  set(${page} "")
  if(EXISTS ${FOLDER}/${page}.html)
    file(READ ${FOLDER}/${page}.html ${page})
  endif()
  if(${page} MATCHES "\\)page\"")
    message(FATAL_ERROR "${page}.html holds the end of a raw string")
  endif()
endforeach()
set(holds_core false)
if(HOLDS_CORE)
  set(holds_core true)
endif()
file(WRITE ${OUTPUT} "// Made by cmake/view_page_text.cmake.
#include \"host_tools/judge/view/page_text.hpp\"

namespace cusp::view {

std::string_view page_text(Page page)
{
    static constexpr char kView[] = R\"page(${view})page\";
    static constexpr char kPlayground[] = R\"page(${playground})page\";
    static constexpr char kStudio[] = R\"page(${studio})page\";
    switch (page) {
        case Page::kView:
            return {kView, sizeof kView - 1};
        case Page::kPlayground:
            return {kPlayground, sizeof kPlayground - 1};
        case Page::kStudio:
            break;
    }
    return {kStudio, sizeof kStudio - 1};
}

bool pages_hold_core() { return ${holds_core}; }

}  // namespace cusp::view
")
