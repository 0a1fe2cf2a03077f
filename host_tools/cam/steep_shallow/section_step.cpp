// The stepover of the curvature across, seen along the vector.
#include "host_tools/cam/steep_shallow/section_step.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/tool_cap.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

namespace cusp::steep_shallow {

using nurbs::SurfacePoint;
using part_model::cap_reach;
using toolpath::stepover;

namespace {

constexpr double kMeshShare = 0.9;      // of the stepover on a flat facet: meshes bend
constexpr double kWidest = 1.8;         // radii
constexpr double kScallopShare = 0.99;  // the rest is for bends along the path

// The projection of a unit vector onto the tangent plane: its length is the cosine of their angle.
Vec3d along_ground(Vec3d across, Vec3d normal) { return across - normal * dot(across, normal); }

}  // namespace

SectionStep::SectionStep(const finishing::SurfaceOperation& work, double scallop)
    : work_{work},
      profile_{work.path_fitter().tool()},
      radius_{work.path_fitter().tool().radius},
      height_{kScallopShare * (scallop - work.outward())},
      widest_{width({0, 0, 1}, {1, 0, 0})}
{
}

// mm: between passes of any end over a plane, along a unit vector in it. What a flank reaches up a wall
// counts as no more than the end does on level ground.
double SectionStep::width(Vec3d normal, Vec3d way) const
{
    const double level = cap_reach(profile_, {0, 0, 1}, {1, 0, 0}, height_);
    return std::min(kWidest * radius_,
                    std::min(level, cap_reach(profile_, normal, way, height_)) +
                        std::min(level, cap_reach(profile_, normal, -way, height_)));
}

std::optional<double> SectionStep::at(
    int surface, double u, double v, Vec3d across, double least_cosine) const
{
    const SurfacePoint p = work_.model().evaluate(surface, u, v);
    const Vec3d normal = upward_normal(p);
    const double e = dot(p.du, p.du);
    const double f = dot(p.du, p.dv);
    const double g = dot(p.dv, p.dv);
    const double det = e * g - f * f;
    if (dot(normal, normal) == 0 || at_pole(p.du, p) || at_pole(p.dv, p) || !(det > 0)) {
        return std::nullopt;
    }
    const Vec3d step = along_ground(across, normal);
    const double square = dot(step, step);
    if (square < least_cosine * least_cosine) {
        return 0.0;
    }
    // The step by du and dv, for its normal curvature.
    const double a = (dot(step, p.du) * g - dot(step, p.dv) * f) / det;
    const double b = (dot(step, p.dv) * e - dot(step, p.du) * f) / det;
    const double curvature =
        -dot(normal, p.duu * (a * a) + p.duv * (2 * a * b) + p.dvv * (b * b)) / square;
    // Contacts are a stepover apart; centres are closer in hollows and farther over hills.
    const double apart = stepover(radius_, height_, curvature) * (1 + radius_ * curvature);
    return std::clamp(apart, 0.0, 2 * radius_) * std::sqrt(square);
}

double SectionStep::on_facet(Vec3d normal, Vec3d across) const
{
    const Vec3d step = along_ground(across, normal);
    const double cosine = norm(step);
    return cosine > 0 ? kMeshShare * width(normal, step / cosine) * cosine : 0;
}

}  // namespace cusp::steep_shallow
