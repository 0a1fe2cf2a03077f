// The survey of the part's edges (solid_edges.hpp) says which loops and which ways there are.
#include "host_tools/job/import/part_edges.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/part_regions.hpp"
#include "host_tools/job/import/solid_edges.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"

#include "fmt/format.h"

namespace cusp::import {

bool names_broken_edges(const std::string& name)
{
    return names_part_region(name) && edge_band(name, 1).has_value();
}

void keep_broken_edges(const std::string& name,
                       double millimetres,
                       const std::vector<std::array<Vec3d, 3>>& facets,
                       std::vector<FileLoop>& loops)
{
    const EdgeBand band = *edge_band(name, millimetres);
    const offset::EdgeTree tree{edges_of(SolidEdges{facets}.loops(band))};
    const auto is_other = [&](const FileLoop& loop) {
        const Vec3d p = loop.loop.front().points.front();
        return !tree.any_nearer(in_plan(p), 3 * kRegionFit);
    };
    loops.erase(std::remove_if(loops.begin(), loops.end(), is_other), loops.end());
    if (loops.empty()) {
        throw InputError(fmt::format(
            "{}: no edge is broken so all around: beside each of its loops the ground would rise "
            "evenly from z {:g} to {:g} mm within {:g} mm; an engraving by a vee goes along parts",
            name, band.low, band.high, band.width));
    }
}

std::vector<job::Chain> edge_ways(const std::string& name,
                                  double millimetres,
                                  const std::vector<std::array<Vec3d, 3>>& facets,
                                  const toolpath::Tool& tool,
                                  double tip)
{
    constexpr double kSameFlank = 0.02;  // mm
    const EdgeBand band = *edge_band(name, millimetres);
    const double flank = elementary::tan(tool.tip_angle / 2);
    if (tool.shape != toolpath::ToolShape::kVee ||
        std::abs((band.high - band.low) * flank - band.width) > kSameFlank) {
        throw InputError(fmt::format(
            "{}: tool {} is no vee of {:.4g} degrees, as these edges need", name, tool.number,
            2 * elementary::atan(band.width / (band.high - band.low)) * 180 / kPi));
    }
    const double wanted = band.high - (band.width + job::kChamferTip) / flank;
    if (std::abs(tip - wanted) > kSameFlank) {
        throw InputError(fmt::format(
            "{}: the tip of tool {} breaks these edges at z {:.6g} mm, top less depth is {:.6g} mm",
            name, tool.number, wanted, tip));
    }
    const EdgeWays ways = SolidEdges{facets}.ways(band, tool);
    if (ways.ways.empty()) {
        throw InputError(fmt::format("{}: tool {} breaks none of these edges without a gouge", name,
                                     tool.number));
    }
    std::vector<job::Chain> chains;
    for (const std::vector<offset::Edge>& way : ways.ways) {
        job::Chain chain;
        std::transform(way.begin(), way.end(), std::back_inserter(chain), drawn_curve);
        chains.push_back(std::move(chain));
    }
    return chains;
}

}  // namespace cusp::import
