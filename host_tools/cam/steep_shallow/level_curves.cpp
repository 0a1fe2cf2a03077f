// Slices keep a little more than the distance; from them Newton's method leads to the part.
#include "host_tools/cam/steep_shallow/level_curves.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/geometry/part_model/tool_core.hpp"

namespace cusp::steep_shallow {

using finishing::ContactTracker;
using finishing::FinishArea;
using finishing::SurfaceOperation;
using part_model::core_of;
using part_model::PartModel;
using part_model::ToolDistance;
using toolpath::Tool;
using waterline_slices::SliceSettings;

namespace {

constexpr double kPitch = 1.0 / 6;    // radii: of slices
constexpr double kCorners = 3;        // corner radii: the same, where that is less
constexpr int kMostTurns = 12;        // of Newton's method
constexpr double kNear = 0.03;        // of the band: how exact
constexpr double kLeastFlat = 0.05;   // cosine: flatter ground is not followed
constexpr double kAround = 1.5;       // radii: the field beyond the part
constexpr double kUpright = 1e-3;     // z of a normal
constexpr double kFacing = 0.985;     // of the normal and the contact: a rim has less
constexpr double kClearOfWall = 0.9;  // radii
constexpr std::size_t kAtOnce = 48;   // places that one thread takes
constexpr double kShortest = 1e-6;    // mm

SliceSettings settings_of(const SurfaceOperation& work)
{
    const Tool& tool = work.path_fitter().tool();
    const double radius = tool.radius;
    const double pitch =
        kPitch *
        (tool.corner_radius > 0 ? std::min(radius, kCorners * tool.corner_radius) : radius);
    const double around = kAround * radius;
    const Vec3d low = work.model().box_low();
    const Vec3d high = work.model().box_high();
    SliceSettings out;
    out.clearance = work.path_fitter().band().offset;
    // So that the slices are no finer than that.
    const double least = tool.corner_radius + out.clearance;
    out.excess = std::sqrt(least * least + pitch * pitch / 2) - least;
    out.least_pitch = pitch;
    out.field = {low.x - around, low.y - around, high.x + around, high.y + around};
    return out;
}

}  // namespace

double LevelLoop::length() const
{
    double sum = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (places[k].in_area) {
            sum += norm(places[(k + 1) % places.size()].tip - places[k].tip);
        }
    }
    return sum;
}

LevelCurves::LevelCurves(const SurfaceOperation& work,
                         const FinishArea& area,
                         const SectionStep& step)
    : work_{work},
      area_{area},
      step_{step},
      slices_{work.model(), work.path_fitter().tool(), settings_of(work)}
{
}

// The distance of a tool that moves level changes by the cosine of the contact's slope at most. The last
// clear place counts where two contacts take turns.
LevelCurves::Touch LevelCurves::touch(Vec2d near, double z) const
{
    const Tool& tool = work_.path_fitter().tool();
    const double wanted = work_.path_fitter().band().offset;
    const double exact = kNear * work_.path_fitter().band().half_width;
    const double limit = wanted + 3 * pitch();
    Vec2d at = near;
    Touch best{{near.x, near.y, z}, {}, {}};
    double best_over = kInfinite;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const Vec3d tip{at.x, at.y, z};
        const ToolDistance found = work_.model().distance(tool, tip, limit);
        if (found.nearest.surface < 0 || !(found.distance < limit)) {
            break;
        }
        const Vec3d into = -core_of(tool, tip).reach(found.nearest.point);
        const double reach = norm(into);
        const double over = found.distance - wanted;
        if (!(reach > kShortest)) {
            // In the part, with no way out to be seen: back to where the tool was clear.
            if (!(best_over < kInfinite)) {
                break;
            }
            at = (at + Vec2d{best.tip.x, best.tip.y}) * 0.5;
            continue;
        }
        if (over >= -exact && over < best_over) {
            best = {tip, found.nearest, into / reach};
            best_over = over;
        }
        if (std::abs(over) <= exact) {
            break;
        }
        const double flat = elementary::hypot(into.x, into.y) / reach;
        if (flat < kLeastFlat) {
            break;
        }
        const double step =
            std::clamp(-over / flat, -pitch(), pitch()) / elementary::hypot(into.x, into.y);
        at = at + Vec2d{into.x, into.y} * step;
    }
    return best;
}

// True if something lies below a tool that is a little thinner: the part beside a wall.
bool LevelCurves::rests(Vec3d tip) const
{
    Tool thin = work_.path_fitter().tool();
    thin.radius *= kClearOfWall;
    thin.corner_radius *= kClearOfWall;
    thin.tip_radius *= kClearOfWall;
    return work_.model().drop_height(thin, tip.x, tip.y).has_value();
}

// True if the tool touches ground there, not a rim.
bool LevelCurves::faces(Vec3d tip) const
{
    const auto found = ContactTracker{work_.path_fitter()}.at(tip.x, tip.y);
    return found && found->facing >= kFacing;
}

LevelPlace LevelCurves::place_at(Vec2d near, double z) const
{
    const Touch found = touch(near, z);
    LevelPlace out{found.tip};
    if (!(norm(found.lean) > 0) || found.lean.z < 0) {
        return out;
    }
    const Vec3d up{0, 0, 1};
    const part_model::NearestPoint& at = found.nearest;
    const auto step = work_.model().is_mesh() ? std::optional{step_.on_facet(found.lean, up)}
                                              : step_.at(at.surface, at.u, at.v, up);
    out.step = step.value_or(0);
    out.in_area = area_.holds(at.point, found.lean) &&
                  (found.lean.z > kUpright ? faces(found.tip) : rests(found.tip));
    return out;
}

std::vector<LevelLoop> LevelCurves::at(double z) const
{
    struct Spot {
        std::size_t loop;
        Vec2d near;
    };
    std::vector<Spot> spots;
    std::size_t loops = 0;
    for (const offset::Contour& contour : slices_.at(z, 0).contours) {
        for (const offset::Edge& edge : contour) {
            spots.push_back({loops, edge.start});
            const int parts = static_cast<int>(length(edge) / pitch());
            for (int k = 1; k < parts; ++k) {
                spots.push_back({loops, point_on(edge, static_cast<double>(k) / parts)});
            }
        }
        ++loops;
    }
    std::vector<LevelPlace> places(spots.size());
    {
        const PartModel::SharedQueries shared{work_.model()};
        parallel::for_each((spots.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t some) {
            const PartModel::SharedQueries::Part queries{work_.model()};
            const std::size_t end = std::min(spots.size(), (some + 1) * kAtOnce);
            for (std::size_t k = some * kAtOnce; k < end; ++k) {
                places[k] = place_at(spots[k].near, z);
            }
        });
    }
    work_.model().forget_queries();
    std::vector<LevelLoop> all(loops);
    for (std::size_t k = 0; k < spots.size(); ++k) {
        std::vector<LevelPlace>& loop = all[spots[k].loop].places;
        if (loop.empty() || norm(places[k].tip - loop.back().tip) > kShortest) {
            loop.push_back(places[k]);
        }
    }
    const auto is_out = [](const LevelLoop& loop) {
        return loop.places.size() < 3 ||
               std::none_of(loop.places.begin(), loop.places.end(),
                            [](const LevelPlace& place) { return place.in_area; });
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_out), all.end());
    return all;
}

}  // namespace cusp::steep_shallow
