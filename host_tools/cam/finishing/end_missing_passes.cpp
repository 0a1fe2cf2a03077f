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
#include "host_tools/cam/finishing/mesh_pencil_curves.hpp"
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
constexpr double kLowestPitches[] = {1.0 / 12,
                                     1.0 / 24};  // radii: of searches, one after the other
constexpr double kLowestShare = 0.7;             // of the scallop: less may stay
constexpr double kPlacesPitch = 1.0 / 12;        // radii: of places that are looked at

// Places by squares in plan as wide as a radius.
class PlacesInPlan {
public:
    PlacesInPlan(const std::vector<Vec3d>& places, double radius) : radius_{radius}
    {
        for (const Vec3d& place : places) {
            squares_[{cell(place.x), cell(place.y)}].push_back(place);
        }
    }

    // True if visit(place) is for one in a square beside the tip's.
    template <class Visit>
    bool any_near(Vec3d tip, const Visit& visit) const
    {
        for (long i = cell(tip.x) - 1; i <= cell(tip.x) + 1; ++i) {
            for (long j = cell(tip.y) - 1; j <= cell(tip.y) + 1; ++j) {
                const auto found = squares_.find({i, j});
                if (found != squares_.end() &&
                    std::any_of(found->second.begin(), found->second.end(), visit)) {
                    return true;
                }
            }
        }
        return false;
    }

private:
    long cell(double at) const { return static_cast<long>(std::floor(at / radius_)); }

    double radius_;
    std::map<std::pair<long, long>, std::vector<Vec3d>> squares_;
};

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
    for (const double pitch : kLowestPitches) {
        cut_lowest(pitch * ground_.path_fitter().tool().radius, cut);
    }
    cut_rest(cut);
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

// The places that the tool can't touch and where more than the scallop stays; one stands for all within a
// pitch.
std::vector<Vec3d> EndScallopCheck::deep_places() const
{
    const double pitch = kPlacesPitch * ground_.path_fitter().tool().radius;
    std::map<std::tuple<long, long, long>, Vec3d> places;
    for (const Cell& cell : blocked_) {
        // corners first: over the border of a part a tool that hangs beside it gets lower
        for (const Vec3d at : {cell.corners[0], cell.corners[1], cell.corners[2], cell.middle()}) {
            places.try_emplace(
                {std::lround(at.x / pitch), std::lround(at.y / pitch), std::lround(at.z / pitch)},
                at);
        }
    }
    std::vector<Vec3d> all;
    for (const auto& [key, place] : places) {
        all.push_back(place);
    }
    std::vector<char> is_deep(all.size());
    parallel::for_each(all.size(), [&](std::size_t k) {
        is_deep[k] = ground_.is_left(all[k], kLowestShare) ? 1 : 0;
    });
    std::vector<Vec3d> out;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (is_deep[k] != 0) {
            out.push_back(all[k]);
        }
    }
    return out;
}

// Passes along the curves where the tool touches twice, as far as they get lower over ground that it can't
// touch.
void EndScallopCheck::cut_lowest(double pitch, const std::function<void(const Points&)>& cut)
{
    const std::vector<Vec3d> places = deep_places();
    if (places.empty()) {
        return;
    }
    const GougeFreePathFitter& fitter = ground_.path_fitter();
    const PlacesInPlan in_plan{places, fitter.tool().radius};
    for (const Points& curve : mesh_pencil_curves_near(places, fitter, pitch)) {
        std::vector<char> lower(curve.size());
        parallel::for_each(curve.size(), [&](std::size_t k) {
            lower[k] = in_plan.any_near(curve[k], [&](Vec3d place) {
                return ground_.gets_lower(curve[k], place, kLowestShare);
            });
        });
        for (std::size_t k = 0; k < curve.size(); ++k) {
            if (lower[k] == 0) {
                continue;
            }
            // from the tip before the first of a row to the one after the last
            const std::size_t first = k > 0 ? k - 1 : 0;
            while (k < curve.size() && lower[k] != 0) {
                ++k;
            }
            const auto at = [&](std::size_t n) {
                return curve.begin() + static_cast<std::ptrdiff_t>(n);
            };
            for (const Points& run :
                 joined_tips({at(first), at(std::min(k + 1, curve.size()))}, fitter, step())) {
                cut(run);
            }
        }
    }
}

// Single tips where no such curve is: beside the border of a part, that a flat end bridges.
void EndScallopCheck::cut_rest(const std::function<void(const Points&)>& cut)
{
    const std::vector<Vec3d> places = deep_places();
    const GougeFreePathFitter& fitter = ground_.path_fitter();
    std::vector<std::optional<Vec3d>> tips(places.size());
    parallel::for_each(places.size(), [&](std::size_t k) {
        fitter.model().forget_queries();
        tips[k] = ground_.low_tip_round(places[k]);
    });
    fitter.model().forget_queries();
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (tips[k] && ground_.gets_lower(*tips[k], places[k], kLowestShare)) {
            for (const Points& run : joined_tips({*tips[k]}, fitter, step())) {
                cut(run);
            }
        }
    }
}

}  // namespace cusp::finishing
