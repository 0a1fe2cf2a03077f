// Straight moves, as tests write them.
#pragma once

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

inline ToolMove rapid(Vec3d end) { return {MoveKind::kRapid, LineTo{end}}; }
inline ToolMove cut(Vec3d end) { return {MoveKind::kCut, LineTo{end}}; }

}  // namespace cusp::toolpath
