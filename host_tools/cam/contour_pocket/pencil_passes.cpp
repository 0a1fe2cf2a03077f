// Follows the lines of pencil_curves() where a pass along them removes enough stock.
#include "host_tools/cam/contour_pocket/pencil_passes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/contour_pocket/height_after_passes.hpp"
#include "host_tools/cam/contour_pocket/pencil_curves.hpp"

namespace cusp::contour_pocket {

using cl_path::ClMove;
using cl_path::ClPath;
using cl_path::ClPathSettings;
using cl_path::drop_path;
using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::PassStart;
using drop_cutter::DropCutter;
using offset::distance;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::Tool;

namespace {

constexpr double kPencilSamplesApart = 0.1;  // of the radius: distance of samples
constexpr double kLongestGap = 3.0;          // radii: a pass continues over shorter gaps
constexpr double kFarthest = 4.0;            // of `distance`
constexpr double kFragment = 2.0;            // radii: shorter lines
constexpr double kLifted = 0.02;             // of the radius: length of a pass that may be raised
constexpr double kLeastStep = 1e-4;          // mm

class PencilPassMaker {
public:
    PencilPassMaker(const Region2d& region,
                    const DropCutter& floor,
                    const ClearedRegion& cleared,
                    const PencilSettings& settings)
        : walls_{region}, floor_{floor}, cleared_{cleared}, settings_{settings}
    {
        leavings_.emplace(cleared, floor);
    }

    std::vector<ClearingPass> run()
    {
        PencilSearch search;
        search.box = box_of(walls_.source());
        search.inside = [this](Vec2d p) {
            return inside(p);
        };
        search.jump = std::max(0.25 * settings_.max_uncut, 2e-3);
        search.fine = 0.3 * settings_.path_settings.plan_tolerance;
        std::vector<PencilCurve> lines = pencil_curves(floor_, search);
        if (settings_.fragments) {
            follow(lines.begin(), lines.end());
            return std::move(passes_);
        }
        const auto fragments =
            std::stable_partition(lines.begin(), lines.end(), [&](const PencilCurve& line) {
                return length_of(line) > kFragment * floor_.tool().radius;
            });
        follow(lines.begin(), fragments);
        // If the tip's height is nearly vertical, its line is found in pieces, some of them
        // beside lines already followed.
        ClearedRegion followed = cleared_;
        followed.passes.insert(followed.passes.end(), passes_.begin(), passes_.end());
        leavings_.emplace(followed, floor_);
        jumps_count_ = false;
        follow(fragments, lines.end());
        return std::move(passes_);
    }

private:
    using Line = std::vector<PencilCurve>::const_iterator;

    static double length_of(const PencilCurve& line)
    {
        double sum = 0.0;
        for (std::size_t i = 1; i < line.points.size(); ++i) {
            sum += distance(line.points[i - 1].at, line.points[i].at);
        }
        return sum;
    }

    void follow(Line begin, Line end)
    {
        for (Line line = begin; line != end; ++line) {
            for (double side_step = settings_.distance; side_step <= kFarthest * settings_.distance;
                 side_step *= 2.0) {
                std::vector<ClearingPass> found = along(*line, side_step);
                const bool low = std::all_of(found.begin(), found.end(),
                                             [&](const ClearingPass& p) { return lies_low(p); });
                if (low || side_step == kFarthest * settings_.distance) {
                    passes_.insert(passes_.end(), found.begin(), found.end());
                    break;
                }
            }
        }
    }

    bool inside(Vec2d p) const
    {
        return !walls_.any_nearer(p, settings_.wall_clearance) && walls_.contains(p);
    }

    // True if the certified pass stays low, except for climbs where it meets other cliffs.
    bool lies_low(const ClearingPass& pass) const
    {
        ClPathSettings path_settings = settings_.path_settings;
        path_settings.arcs = path_settings.nurbs = false;
        const ClPath path = drop_path(pass.path, floor_, path_settings);
        const double lift_allowed = 1.5 * settings_.path_settings.height_tolerance +
                                    2.0 * settings_.path_settings.clearance_reserve;
        double length = 0.0;
        Vec3d from = path.start;
        for (const ClMove& move : path.moves) {
            const Vec3d middle = (from + move.end) * 0.5;
            const bool lifted = middle.z > floor_.tip_height({middle.x, middle.y}) + lift_allowed;
            length += lifted ? distance(in_plan(from), {move.end.x, move.end.y}) : 0.0;
            from = move.end;
        }
        return length < kLifted * floor_.tool().radius;
    }

    // Passes along the parts of the curve where passes may run and remove enough.
    std::vector<ClearingPass> along(const PencilCurve& line, double side_step)
    {
        std::vector<Vec2d> path;
        std::vector<bool> kept;
        double since = kUnbounded;
        const double apart = kPencilSamplesApart * floor_.tool().radius;
        for (const PencilPoint& point : line.points) {
            const Vec2d p = point.at + point.low_side * side_step;
            const double step = path.empty() ? 0.0 : distance(path.back(), p);
            if (!inside(p) || (!path.empty() && step < kLeastStep)) {
                continue;
            }
            since += step;
            const bool again = since >= apart;
            kept.push_back((jumps_count_ && point.jump) ||
                           (again ? removes_enough(p) : kept.back()));
            since = again ? 0.0 : since;
            path.push_back(p);
        }
        if (line.closed && path.size() > 2) {
            path.push_back(path.front());
            kept.push_back(kept.front());
        }
        fill_openings(path, kept);
        return passes_on(path, kept);
    }

    // True if the tool there removes more than may remain.
    bool removes_enough(Vec2d q)
    {
        constexpr double kRings[] = {0.0, 0.3, 0.55, 0.75, 0.9, 0.985};
        constexpr int kSpokes = 16;
        const Tool& tool = floor_.tool();
        const auto cl = floor_.drop(q).value_or(DropCutter::ClPoint{-kUnbounded, {}, 0});
        const double cos_slope = 1.0 / std::sqrt(1.0 + dot(cl.slope, cl.slope));
        for (const double ring : kRings) {
            const double out = ring * tool.radius;
            const double cut = cl.z + profile_height(tool, out);
            for (int spoke = 0; spoke < (ring > 0.0 ? kSpokes : 1); ++spoke) {
                const double angle = 2 * kPi * spoke / kSpokes;
                const Vec2d p = q + Vec2d{elementary::cos(angle), elementary::sin(angle)} * out;
                if ((leavings_->height(p) - cut) * cos_slope > settings_.max_uncut) {
                    return true;
                }
            }
        }
        return false;
    }

    // Passes continue over short gaps instead of retracting.
    void fill_openings(const std::vector<Vec2d>& path, std::vector<bool>& kept) const
    {
        const double longest = kLongestGap * floor_.tool().radius;
        std::size_t last = path.size();
        double since = 0.0;
        for (std::size_t i = 0; i < path.size(); ++i) {
            since += i > 0 ? distance(path[i - 1], path[i]) : 0.0;
            if (!kept[i]) {
                continue;
            }
            if (last < path.size() && since < longest) {
                std::fill(kept.begin() + static_cast<std::ptrdiff_t>(last),
                          kept.begin() + static_cast<std::ptrdiff_t>(i), true);
            }
            last = i;
            since = 0.0;
        }
    }

    // A pass for each stretch of the path, from the place before it to the place after it.
    std::vector<ClearingPass> passes_on(const std::vector<Vec2d>& path,
                                        const std::vector<bool>& kept) const
    {
        std::vector<ClearingPass> passes;
        ClearingPass pass;
        const auto close = [&] {
            if (!pass.path.empty()) {
                pass.start = PassStart::kRetractAndDrop;
                pass.is_pencil = true;
                pass.wall_distance = settings_.wall_clearance;
                passes.push_back(pass);
                pass.path.clear();
            }
        };
        const double longest = 0.25 * floor_.tool().radius;
        for (std::size_t i = 1; i < path.size(); ++i) {
            const bool on = kept[i - 1] || kept[i];
            const bool whole =
                distance(path[i - 1], path[i]) < longest && inside((path[i - 1] + path[i]) * 0.5);
            if (on && whole) {
                pass.path.push_back(line_edge(path[i - 1], path[i]));
            } else {
                close();
            }
        }
        close();
        return passes;
    }

    RegionOffset walls_;
    const DropCutter& floor_;
    const ClearedRegion& cleared_;
    std::optional<HeightAfterPasses> leavings_;
    bool jumps_count_{true};  // true: jumps are followed, whatever stock is left there
    const PencilSettings& settings_;
    std::vector<ClearingPass> passes_;
};

}  // namespace

std::vector<ClearingPass> pencil_passes(const Region2d& region,
                                        const DropCutter& floor,
                                        const ClearedRegion& cleared,
                                        const PencilSettings& settings)
{
    return PencilPassMaker{region, floor, cleared, settings}.run();
}

}  // namespace cusp::contour_pocket
