// Texts of DXF drawings.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

#include "fmt/format.h"

namespace cusp::test {

// Groups: code, value.
using DxfGroups = std::vector<std::pair<int, std::string>>;

inline std::string dxf_groups(const DxfGroups& groups)
{
    std::string out;
    for (const auto& [code, value] : groups) {
        out += fmt::format("{}\n{}\n", code, value);
    }
    return out;
}

// header  groups of variables: {9, "$INSUNITS"}, {70, "5"}
inline std::string dxf_drawing(const std::string& entities,
                               const DxfGroups& header = {},
                               const std::string& blocks = "")
{
    return "0\nSECTION\n2\nHEADER\n" + dxf_groups(header) + "0\nENDSEC\n" +
           (blocks.empty() ? "" : "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n") +
           "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
}

inline std::string dxf_circle(Vec2d centre, double radius, const std::string& layer = "o")
{
    return fmt::format("0\nCIRCLE\n8\n{}\n10\n{}\n20\n{}\n40\n{}\n", layer, centre.x, centre.y,
                       radius);
}

inline std::string dxf_line(Vec2d a, Vec2d b, const std::string& layer = "o")
{
    return fmt::format("0\nLINE\n8\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer, a.x, a.y, b.x,
                       b.y);
}

inline std::string dxf_polyline(const std::vector<Vec2d>& corners,
                                bool closed = true,
                                const std::string& layer = "o")
{
    std::string out = fmt::format("0\nLWPOLYLINE\n8\n{}\n90\n{}\n70\n{}\n", layer, corners.size(),
                                  closed ? 1 : 0);
    for (const Vec2d p : corners) {
        out += fmt::format("10\n{}\n20\n{}\n", p.x, p.y);
    }
    return out;
}

inline std::string dxf_rectangle(Vec2d low, Vec2d high)
{
    return dxf_polyline({low, {high.x, low.y}, high, {low.x, high.y}});
}

}  // namespace cusp::test
