// Passes over the cells that miss one: traced over ground, along walls, and through the lowest tips over
// what the tool can't touch.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/joined_tips.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
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

Vec3d level_along(Vec3d normal)
{
    return Vec3d{-normal.y, normal.x, 0} / elementary::hypot(normal.x, normal.y);
}

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

void MeshScallopCheck::add_missing_passes(const std::function<void(const Points&)>& cut)
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
bool MeshScallopCheck::cut_missing(const std::function<void(const Points&)>& cut)
{
    std::stable_sort(open_.begin(), open_.end(), [](const Cell& a, const Cell& b) {
        const auto height = [](const Cell& cell) {
            return cell.normal.z < kUprightNormal ? cell.middle().z : kInfinite;
        };
        return height(a) < height(b);
    });
    bool some = false;
    for (const Cell& cell : open_) {
        if (!ground_.missing_tip(cell.place())) {
            continue;
        }
        for (const Points& run :
             joined_tips(longest_trace(cell.place()), ground_.path_fitter(), step())) {
            cut(run);
            some = true;
        }
    }
    return some;
}

Points MeshScallopCheck::longest_trace(const MeshPlace& from) const
{
    if (from.normal.z < kUprightNormal) {
        return trace_wall(from);
    }
    Points one = trace(from, {1, 0, 0});
    Points other = trace(from, {0, 1, 0});
    return length_of(other) > length_of(one) ? other : one;
}

// The missing tips along a line over the mesh in plan, both ways, as far as tips are missing.
Points MeshScallopCheck::trace(const MeshPlace& from, Vec3d way) const
{
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        MeshPlace at = from;
        for (int k = 0; k < kMostTraced; ++k) {
            const std::optional<Vec3d> tip = ground_.missing_tip(at);
            if (!tip) {
                break;
            }
            if (k > 0 || sign < 0) {
                out.push_back(*tip);
            }
            const double slant = dot(at.normal, way) / at.normal.z;
            const Vec3d next =
                at.point + way * (sign * kTraceStep * step() / std::sqrt(1 + slant * slant));
            const auto top = ground_.path_fitter().model().height_at(next.x, next.y);
            if (!top) {
                break;
            }
            at = {top->point, top->normal};
        }
        if (sign < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

// The place of a wall that a tool touches which moves level to it, from beside the last place.
std::optional<MeshPlace> MeshScallopCheck::beside_on_wall(const MeshPlace& at, Vec3d tip) const
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

// The missing tips along a wall at one height, both ways.
Points MeshScallopCheck::trace_wall(const MeshPlace& from) const
{
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        std::optional<MeshPlace> at = from;
        for (int k = 0; k < kMostTraced && at; ++k) {
            const std::optional<Vec3d> tip = ground_.missing_tip(*at);
            if (!tip) {
                break;
            }
            if (k > 0 || sign < 0) {
                out.push_back(*tip);
            }
            const double way = kTraceStep * step();
            const Vec3d last = at->point;
            at = beside_on_wall(*at, *tip + level_along(at->normal) * (sign * way));
            if (at && norm(at->point - last) < kLeastWay * way) {
                at.reset();  // it turns round a rim
            }
        }
        if (sign < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

// Passes through the lowest tips over ground that the tool can't touch, where they remove more than the
// scallop. One place stands for all within a share of a step.
void MeshScallopCheck::cut_lowest(const std::function<void(const Points&)>& cut)
{
    std::map<std::tuple<long, long, long>, MeshPlace> places;
    const double size = kCluster * step();
    for (const Cell& cell : blocked_) {
        const Vec3d at = cell.middle();
        places.try_emplace(
            {std::lround(at.x / size), std::lround(at.y / size), std::lround(at.z / size)},
            cell.place());
    }
    std::vector<MeshPlace> all;
    for (const auto& [key, place] : places) {
        all.push_back(place);
    }
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
