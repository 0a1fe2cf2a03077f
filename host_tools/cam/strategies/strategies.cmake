# The strategies, in the order in which errors and help name them: MODULE::RECORD. A new one is one line.
set(CUSP_STRATEGIES
  contour_pocket::kContourPocket
  adaptive_isocurve::kAdaptiveIsocurve
  grid_pocket::kGridPocket
  hull_rough::kHullRough
  adaptive_isocurve::kCompleteIsocurves
  steep_shallow::kParallelPlanes
  steep_shallow::kWaterline
  steep_shallow::kSteepShallow
  contour_pocket::kPocket
  prismatic::kProfile
  prismatic::kDrill
  prismatic::kBore
  prismatic::kThreadMill
  prismatic::kSlot
  prismatic::kFace
  prismatic::kEngrave
  prismatic::kVCarve
  prismatic::kChamfer
)

# The folders of their modules, each once, in CUSP_STRATEGY_MODULES.
list(TRANSFORM CUSP_STRATEGIES REPLACE "::.*" "" OUTPUT_VARIABLE CUSP_STRATEGY_MODULES)
list(REMOVE_DUPLICATES CUSP_STRATEGY_MODULES)

# Writes the source that has their table.
function(cusp_strategy_table file)
  foreach(record IN LISTS CUSP_STRATEGIES)
    string(REGEX REPLACE "(.*)::(.*)" "namespace cusp::\\1 {\nextern const job::Strategy \\2;\n}\n" declared ${record})
    string(APPEND records "${declared}")
    string(APPEND table "        &${record},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT [=[
// Made by host_tools/cam/strategies/strategies.cmake.
#include "host_tools/cam/strategies/strategies.hpp"

@records@
namespace cusp::strategies {

const job::Strategies& all()
{
    static const job::Strategies kAll{
@table@    };
    return kAll;
}

}  // namespace cusp::strategies
]=])
endfunction()
