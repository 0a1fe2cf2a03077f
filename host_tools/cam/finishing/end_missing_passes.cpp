// Passes over the cells that miss one: traced over ground, along walls, and through the lowest tips over
// what the tool can't touch.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/end_scallop_check.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/joined_tips.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/geometry/part_model/tool_core.hpp"

namespace cusp::finishing {

using part_model::core_of;
using part_model::PartModel;

namespace {

constexpr int kOpenRounds = 5;
constexpr int kMostTouches = 6;       // of a tool that follows a wall
constexpr double kLeastFlat = 0.05;   // cosine: flatter ground is no wall
constexpr double kLeastReach = 1e-9;  // mm
constexpr double kLeastWay = 0.1;     // of the tool's: of its contact
constexpr double kCluster = 0.5;      // steps: of ground that one lowest tip is looked for
constexpr double kChained = 2;        // steps: between tips of one pass
constexpr int kLowestRounds = 2;
constexpr double kSameLowest = 0.02;  // steps

// Tips that lie near each other, in an order along the curve that they make.
std::vector<Points> chains_of(Points tips, double apart)
{
    std::vector<Points> out;
    while (!tips.empty()) {
        Points chain{tips.back()};
        tips.pop_back();
        for (int end = 0; end < 2; ++end) {
            for (;;) {
                const auto nearest =
                    std::min_element(tips.begin(), tips.end(), [&](Vec3d a, Vec3d b) {
                        return norm(a - chain.back()) < norm(b - chain.back());
                    });
                if (nearest == tips.end() || norm(*nearest - chain.back()) > apart) {
                    break;
                }
                chain.push_back(*nearest);
                tips.erase(nearest);
            }
            std::reverse(chain.begin(), chain.end());
        }
        out.push_back(std::move(chain));
    }
    return out;
}

}  // namespace

void EndScallopCheck::add_missing_passes(const std::function<void(const Points&)>& cut)
{
    for (int round = 0; round < kOpenRounds && !open_.empty(); ++round) {
        if (!cut_missing(cut)) {
            break;
        }
        Findings found = look_at(open_);
        open_ = std::move(found.open);
        blocked_.insert(blocked_.end(), found.blocked.begin(), found.blocked.end());
    }
    for (int round = 0; round < kLowestRounds; ++round) {
        cut_lowest(cut);
    }
    measure_left();
}

// The lowest walls first: a pass at the foot of a wall also cuts the stock over it. Returns whether some
// pass was cut.
bool EndScallopCheck::cut_missing(const std::function<void(const Points&)>& cut)
{
    std::stable_sort(open_.begin(), open_.end(), [](const Cell& a, const Cell& b) {
        const auto height = [](const Cell& cell) {
            return cell.normal.z < kUprightNormal ? cell.middle().z : kInfinite;
        };
        return height(a) < height(b);
    });
    bool some = false;
    for (const Cell& cell : open_) {
        if (!ground_.missing_tip(place_of(cell))) {
            continue;
        }
        for (const Points& run :
             joined_tips(longest_trace(place_of(cell)), ground_.path_fitter(), step())) {
            cut(run);
            some = true;
        }
    }
    return some;
}

Points EndScallopCheck::longest_trace(const MeshPlace& from) const
{
    return from.normal.z < kUprightNormal
               ? trace_wall(from)
               : longest_over_mesh(from, ground_.path_fitter().model(), step(),
                                   [&](const MeshPlace& at) { return ground_.missing_tip(at); });
}

// The place of a wall that a tool touches which moves level to it, from beside the last place.
std::optional<MeshPlace> EndScallopCheck::beside_on_wall(const MeshPlace& at, Vec3d tip) const
{
    const GougeFreePathFitter& fitter = ground_.path_fitter();
    const toolpath::Tool& tool = fitter.tool();
    for (int turn = 0; turn < kMostTouches; ++turn) {
        const auto found = fitter.model().distance(tool, tip, tool.radius);
        const Vec3d into = -core_of(tool, tip).reach(found.nearest.point);
        const double reach = norm(into);
        const double flat = elementary::hypot(into.x, into.y);
        if (found.nearest.surface < 0 || !(reach > kLeastReach) || flat < kLeastFlat * reach) {
            return std::nullopt;
        }
        const double over = found.distance - fitter.band().offset;
        if (std::abs(over) < kLeastReach + 0.1 * fitter.band().half_width) {
            const Vec3d normal = into / reach;
            return normal.z < kUprightNormal && normal.z >= 0 && dot(normal, at.normal) > 0
                       ? std::optional{MeshPlace{found.nearest.point, normal}}
                       : std::nullopt;
        }
        tip = tip - Vec3d{into.x, into.y, 0} * (over * reach / (flat * flat));
    }
    return std::nullopt;
}

// The missing tips along a wall at one height, both ways; not round a rim.
Points EndScallopCheck::trace_wall(const MeshPlace& from) const
{
    const double step_along = kTraceStep * step();
    return traced(
        from, [&](const MeshPlace& at) { return ground_.missing_tip(at); },
        [&](const MeshPlace& last, Vec3d tip, double way) {
            std::optional<MeshPlace> at =
                beside_on_wall(last, tip + level_along(last.normal) * (way * step_along));
            if (at && norm(at->point - last.point) < kLeastWay * step_along) {
                at.reset();
            }
            return at;
        });
}

// One place stands for all within a share of a step.
std::vector<MeshPlace> EndScallopCheck::blocked_places() const
{
    std::map<std::tuple<long, long, long>, MeshPlace> places;
    const double size = kCluster * step();
    for (const Cell& cell : blocked_) {
        const Vec3d at = cell.middle();
        places.try_emplace(
            {std::lround(at.x / size), std::lround(at.y / size), std::lround(at.z / size)},
            place_of(cell));
    }
    std::vector<MeshPlace> all;
    for (const auto& [key, place] : places) {
        all.push_back(place);
    }
    return all;
}

// Passes through the lowest tips over ground that the tool can't touch, where they remove more than the
// scallop.
void EndScallopCheck::cut_lowest(const std::function<void(const Points&)>& cut)
{
    const std::vector<MeshPlace> all = blocked_places();
    std::vector<std::optional<Vec3d>> found(all.size());
    const GougeFreePathFitter& fitter = ground_.path_fitter();
    parallel::for_each(all.size(), [&](std::size_t k) {
        fitter.model().forget_queries();
        found[k] = ground_.lower_tip(all[k]);
    });
    fitter.model().forget_queries();
    Points tips;
    for (const std::optional<Vec3d>& tip : found) {
        if (tip && std::none_of(tips.begin(), tips.end(), [&](Vec3d other) {
                return norm(other - *tip) < kSameLowest * step();
            })) {
            tips.push_back(*tip);
        }
    }
    for (const Points& chain : chains_of(std::move(tips), kChained * step())) {
        for (const Points& run : joined_tips(chain, fitter, step())) {
            cut(run);
        }
    }
}

}  // namespace cusp::finishing
