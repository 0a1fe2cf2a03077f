# find_package(cusp): the core for boards, and cusp::plan, cusp::verify, cusp::simulate for programs.
include(CMakeFindDependencyMacro)
foreach(package fmt nlohmann_json pugixml TBB)
  # The core alone needs none of them: programs that plan link them.
  find_package(${package} QUIET)
endforeach()
include(${CMAKE_CURRENT_LIST_DIR}/cuspTargets.cmake)
