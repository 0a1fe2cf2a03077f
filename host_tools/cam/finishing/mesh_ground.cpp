// Every query is one over the hierarchy of facets, or over the moves in a window.
#include "host_tools/cam/finishing/mesh_ground.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/geometry/part_model/tool_cap.hpp"

namespace cusp::finishing {

using part_model::cap_reach;
using part_model::PartModel;
using toolpath::Tool;

namespace {

constexpr double kLevelGround = 1e-6;  // sine of the slope under a flat end
constexpr double kLean = 1e-4;         // mm: of a wall, of which vertices are rounded
constexpr double kSlack = 0.25;        // of the band's offset
constexpr double kThinner = 0.9;       // radii
constexpr int kRimPlaces = 12;         // places of a flat end
constexpr double kFineOfRadius = 0.5;
constexpr double kOverShare = 1.01;
constexpr double kRoundPlace[] = {0.05, 0.35, 0.65, 0.95};  // radii
constexpr double kFirstStep = 0.15;                         // radii
constexpr double kLastStep = 0.004;                         // radii

}  // namespace

MeshGround::MeshGround(const GougeFreePathFitter& path_fitter, double scallop, double path_off)
    : path_fitter_{path_fitter},
      scallop_{scallop},
      path_off_{path_off},
      swept_{path_fitter.tool(), scallop},
      step_{std::min(2 * cap_reach(swept_.profile(), {0, 0, 1}, {1, 0, 0}, scallop),
                     path_fitter.tool().radius)},
      height_{path_fitter.model().box_high().z - path_fitter.model().box_low().z}
{
    const double flat = swept_.profile().core().radius;
    const Vec3d up{0, 0, swept_.profile().corner() + path_fitter.band().offset};
    for (int k = 0; k < kRimPlaces && flat > 0; ++k) {
        const double turn = 2 * kPi * k / kRimPlaces;
        const Vec3d out{elementary::cos(turn), elementary::sin(turn), 0};
        level_off_.push_back(up + out * flat);
        level_off_.push_back(up + out * (0.5 * flat));
    }
}

double MeshGround::slack() const { return kSlack * path_fitter_.band().offset; }

MeshGround::Side MeshGround::side(Vec3d normal) const
{
    const ToolWindow window = swept_.window(normal, path_fitter_.band().offset);
    const double tilt = elementary::hypot(normal.x, normal.y);
    const Vec3d level = tilt > kLevelFacet ? Vec3d{-normal.y, normal.x, 0} / tilt : Vec3d{1, 0, 0};
    const auto width = [&](Vec3d way) {
        return cap_reach(swept_.profile(), normal, way, scallop_) +
               cap_reach(swept_.profile(), normal, -way, scallop_);
    };
    const double fine = std::min(
        {width(level), width(cross(normal, level)), kFineOfRadius * path_fitter_.tool().radius});
    const bool upright = height_ * normal.z <= kLean;
    return {normal, window, upright, fine};
}

// Straight over a place that a sharp corner touches there is its flank: only a ball is asked for that.
Vec3d MeshGround::lifted(const Side& side, Vec3d point, double height) const
{
    const bool along_z = swept_.profile().core().is_point() && side.normal.z >= kSteepNormal;
    return raised(point, side.normal, height, along_z);
}

bool MeshGround::is_covered(const Side& side, Vec3d point, double share) const
{
    const Vec3d top = lifted(side, point, share * scallop_);
    return swept_.any_through(side.window, point, [&](std::uint32_t move) {
        return swept_.removes(move, top, path_off_);
    });
}

bool MeshGround::is_covered(const Side& side,
                            const std::array<Vec3d, 3>& corners,
                            std::uint32_t& last) const
{
    std::array<Vec3d, 3> top;
    for (std::size_t k = 0; k < 3; ++k) {
        top[k] = lifted(side, corners[k], scallop_);
    }
    const auto all = [&](std::uint32_t move) {
        return std::all_of(top.begin(), top.end(),
                           [&](Vec3d at) { return swept_.removes(move, at, path_off_); });
    };
    if (last < swept_.moves() && all(last)) {
        return true;
    }
    return swept_.any_through(side.window, (corners[0] + corners[1] + corners[2]) / 3.0,
                              [&](std::uint32_t move) {
                                  if (!all(move)) {
                                      return false;
                                  }
                                  last = move;
                                  return true;
                              });
}

PartModel::Blocked MeshGround::blocked(const Side& side, const std::array<Vec3d, 3>& corners) const
{
    std::array<Vec3d, 3> tips;
    for (std::size_t k = 0; k < 3; ++k) {
        tips[k] = tip_of(corners[k] + side.window.off);
    }
    const double least = path_fitter_.band().offset - slack();
    const PartModel::Blocked found = path_fitter_.model().blocked(path_fitter_.tool(), tips, least);
    if (found != PartModel::Blocked::kFree &&
        touching_tip(side, (corners[0] + corners[1] + corners[2]) / 3.0)) {
        return PartModel::Blocked::kFree;
    }
    return found;
}

std::optional<Vec3d> MeshGround::touching_tip(const Side& side, Vec3d point) const
{
    const double least = path_fitter_.band().offset - slack();
    const auto is_clear = [&](Vec3d tip) {
        return path_fitter_.model().is_distance_at_least(path_fitter_.tool(), tip, least);
    };
    if (const Vec3d tip = tip_of(point + side.window.off); is_clear(tip)) {
        return tip;
    }
    if (elementary::hypot(side.normal.x, side.normal.y) < kLevelGround) {
        for (const Vec3d& off : level_off_) {
            if (const Vec3d tip = tip_of(point + off); is_clear(tip)) {
                return tip;
            }
        }
    }
    return std::nullopt;
}

// On a steep wall rounding may raise the wall itself over the point; beside a vertical one it is looked at
// a little off it.
bool MeshGround::is_hidden(const MeshPlace& place) const
{
    const bool steep = place.normal.z < kUprightNormal;
    const Vec3d at = steep ? place.point + place.normal * scallop_ : place.point;
    const auto top = path_fitter_.model().height_at(at.x, at.y);
    const double over = steep && place.normal.z > kLevelFacet ? kHiddenBeside / place.normal.z : 0;
    return top && top->point.z > at.z + std::max(kHidden, over);
}

bool MeshGround::rests(Vec3d tip) const
{
    Tool thin = path_fitter_.tool();
    thin.radius *= kThinner;
    thin.corner_radius *= kThinner;
    thin.tip_radius *= kThinner;
    return path_fitter_.model().drop_height(thin, tip.x, tip.y).has_value();
}

std::optional<Vec3d> MeshGround::missing_tip(const MeshPlace& place) const
{
    const Side here = side(place.normal);
    if (is_covered(here, place.point, kPlaceShare) ||
        !path_fitter_.area().holds(place.point, place.normal) || is_hidden(place)) {
        return std::nullopt;
    }
    const std::optional<Vec3d> tip = touching_tip(here, place.point);
    return tip && (!here.upright || rests(*tip)) ? tip : std::nullopt;
}

double MeshGround::left(Vec3d point, double enough) const
{
    return swept_.distance(point, path_fitter_.tool().radius, enough);
}

bool MeshGround::gets_lower(Vec3d tip, Vec3d place, double share) const
{
    const Tool& tool = path_fitter_.tool();
    const double away = elementary::hypot(place.x - tip.x, place.y - tip.y);
    if (away > tool.radius) {
        return false;
    }
    return is_left({place.x, place.y, tip.z + profile_height(tool, away)}, share);
}

std::optional<Vec3d> MeshGround::low_tip_round(Vec3d place) const
{
    const Tool& tool = path_fitter_.tool();
    std::optional<Vec3d> best;
    double lowest = kInfinite;
    const auto try_round = [&](Vec3d middle, double away) {
        bool better = false;
        for (int k = 0; k < kRimPlaces; ++k) {
            const double turn = 2 * kPi * k / kRimPlaces;
            const double x = middle.x + away * elementary::cos(turn);
            const double y = middle.y + away * elementary::sin(turn);
            const double off = elementary::hypot(x - place.x, y - place.y);
            const auto tip = off < tool.radius ? path_fitter_.drop(x, y) : std::nullopt;
            if (tip && tip->z + profile_height(tool, off) < lowest) {
                lowest = tip->z + profile_height(tool, off);
                best = tip;
                better = true;
            }
        }
        return better;
    };
    for (const double away : kRoundPlace) {
        try_round(place, away * tool.radius);
    }
    for (double step = kFirstStep * tool.radius; best && step > kLastStep * tool.radius;) {
        step *= try_round(*best, step) ? 1 : 0.5;
    }
    return best;
}

bool MeshGround::is_left(Vec3d point, double share) const
{
    const double allowed = share * scallop_;
    return swept_.distance(point, kOverShare * allowed, allowed) > allowed;
}

}  // namespace cusp::finishing
