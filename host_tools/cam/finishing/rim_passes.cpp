// Passes over open rims of vertical walls. The tolerance leaves a sliver on such a wall, up to the
// top of the stock. A pass along the rim removes it.
#include <algorithm>
#include <cmath>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/joined_tips.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
#include "host_tools/geometry/part_model/surface_length.hpp"

namespace cusp::finishing {

using nurbs::Surface;
using part_model::length_between;

namespace {

constexpr double kUprightRim = 0.2;  // z of the normal: less is proved along the normal
constexpr double kRimStep = 0.125;   // in stepovers
constexpr int kLeastRim = 16;        // points
constexpr int kMostRim = 4000;

}  // namespace

// The tip over a point of a rim; none where it would remove no more than the scallop.
std::optional<Vec3d> ScallopCheck::tip_over_rim(int surface, Vec2d place) const
{
    if (!path_fitter_.model().inside_trims(surface, place.x, place.y)) {
        return std::nullopt;
    }
    const Corner at = corner(surface, place.x, place.y);
    if (at.normal.z >= kUprightRim || !path_fitter_.area().holds(at.point.point, at.normal) ||
        is_hidden(at)) {
        return std::nullopt;
    }
    const Vec3d p = at.point.point;
    const double now = places_.swept().lowest(p.x, p.y).height;
    if (now <= p.z + scallop_) {
        return std::nullopt;
    }
    const std::optional<Vec3d> tip = path_fitter_.drop(p.x, p.y);
    return tip && now - tip->z > scallop_ ? tip : std::nullopt;
}

void ScallopCheck::add_pass_over_rim(int surface,
                                     Vec2d from,
                                     Vec2d to,
                                     const std::function<void(const Points&)>& cut)
{
    const double length = length_between(path_fitter_.model(), surface, from, to, kLeastRim);
    const int parts =
        std::clamp(static_cast<int>(length / (kRimStep * places_.step())), kLeastRim, kMostRim);
    Points run;
    const auto close = [&] {
        if (!run.empty()) {
            for (const Points& pass : joined_tips(run, path_fitter_, places_.step())) {
                cut(pass);
            }
        }
        run.clear();
    };
    for (int k = 0; k <= parts; ++k) {
        const double share = static_cast<double>(k) / parts;
        if (const auto tip = tip_over_rim(surface, from * (1 - share) + to * share)) {
            run.push_back(*tip);
        } else {
            close();
        }
    }
    close();
}

void ScallopCheck::add_rim_passes(int surface, const std::function<void(const Points&)>& cut)
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const std::array<Vec2d, 4> corners{Vec2d{s.u_begin(), s.v_begin()},
                                       Vec2d{s.u_end(), s.v_begin()}, Vec2d{s.u_end(), s.v_end()},
                                       Vec2d{s.u_begin(), s.v_end()}};
    for (std::size_t k = 0; k < corners.size(); ++k) {
        add_pass_over_rim(surface, corners[k], corners[(k + 1) % corners.size()], cut);
    }
}

}  // namespace cusp::finishing
