// A ball, a flat and a bull end of 6 mm.
#pragma once

#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::test {

inline const toolpath::Tool kBall{1, toolpath::ToolShape::kBall, 3, 3};
inline const toolpath::Tool kFlat{1, toolpath::ToolShape::kFlat, 3, 0};
inline const toolpath::Tool kBull{1, toolpath::ToolShape::kBull, 3, 1};

}  // namespace cusp::test
