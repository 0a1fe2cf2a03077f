// Each face is looked at in samples: normals that meet in one vertical axis make a cylinder.
#include "host_tools/job/import/cad_holes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::import {

using job::Hole;
using nurbs::derivatives_at;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr int kHoleLooks = 13;         // samples along u and along v
constexpr double kUprightAxis = 1e-5;  // z of a unit normal
constexpr double kRound = 1e-4;        // of the radius
constexpr double kSameHole = 1e-3;     // mm

struct Sample {
    Vec3d point;
    Vec3d normal;  // unit, out of the solid; 0 at a pole
};

struct SampledFace {
    std::vector<Sample> samples;  // kHoleLooks rows of kHoleLooks
    double low;                   // z
    double high;
};

// The inner side of a vertical cylinder, or a part of it.
struct Wall {
    Vec2d axis;
    double radius;
    double low;  // z
    double high;
    double angle;  // radians around the axis
};

SampledFace sampled(const Surface& surface, double outwards)
{
    SampledFace face{{}, kUnbounded, -kUnbounded};
    for (int i = 0; i < kHoleLooks; ++i) {
        for (int j = 0; j < kHoleLooks; ++j) {
            const auto at = [](double begin, double end, int k) {
                return begin + (end - begin) * k / (kHoleLooks - 1);
            };
            const SurfacePoint p =
                derivatives_at(surface, at(surface.u_begin(), surface.u_end(), i),
                               at(surface.v_begin(), surface.v_end(), j));
            const Vec3d n = cross(p.du, p.dv);
            constexpr double kPole = 1e-9;
            const double sides = norm(p.du) + norm(p.dv);
            const double size = norm(n) > kPole * sides * sides ? norm(n) : 0.0;
            face.samples.push_back({p.point, size > 0 ? n * (outwards / size) : Vec3d{}});
            face.low = std::min(face.low, p.point.z);
            face.high = std::max(face.high, p.point.z);
        }
    }
    return face;
}

// The place where the normals of two samples meet in plan.
std::optional<Vec2d> meeting(const Sample& a, const Sample& b)
{
    constexpr double kParallel = 1e-3;
    const Vec2d n = in_plan(a.normal);
    const Vec2d m = in_plan(b.normal);
    const double turn = cross(n, m);
    if (std::abs(turn) < kParallel) {
        return std::nullopt;
    }
    return in_plan(a.point) + n * (cross(in_plan(b.point - a.point), m) / turn);
}

// Radians that the samples go around the axis along u or along v, whichever is more.
double angle_around(const SampledFace& face, Vec2d axis)
{
    const auto direction = [&](int i, int j) {
        return in_plan(face.samples[static_cast<std::size_t>(i * kHoleLooks + j)].point) - axis;
    };
    const auto between = [](Vec2d a, Vec2d b) {
        return std::abs(elementary::atan2(cross(a, b), dot(a, b)));
    };
    double along_u = 0;
    double along_v = 0;
    const int middle = kHoleLooks / 2;
    for (int k = 1; k < kHoleLooks; ++k) {
        along_u += between(direction(k - 1, middle), direction(k, middle));
        along_v += between(direction(middle, k - 1), direction(middle, k));
    }
    return std::max(along_u, along_v);
}

std::optional<Wall> wall_of(const SampledFace& face)
{
    std::optional<Vec2d> axis;
    for (const Sample& sample : face.samples) {
        if (!(std::abs(sample.normal.z) <= kUprightAxis) || norm(sample.normal) == 0) {
            return std::nullopt;
        }
        axis = axis ? axis : meeting(face.samples.front(), sample);
    }
    if (!axis) {
        return std::nullopt;
    }
    const double radius = norm(in_plan(face.samples.front().point) - *axis);
    for (const Sample& sample : face.samples) {
        const Vec2d inward = *axis - in_plan(sample.point);
        if (std::abs(norm(inward) - radius) > std::max(kRound * radius, kSameHole) ||
            dot(in_plan(sample.normal), inward) <= 0) {
            return std::nullopt;
        }
    }
    return Wall{*axis, radius, face.low, face.high, angle_around(face, *axis)};
}

bool are_one(const Wall& a, const Wall& b)
{
    return norm(a.axis - b.axis) <= kSameHole && std::abs(a.radius - b.radius) <= kSameHole;
}

// True if the walls go all around, over all heights that they have.
bool is_complete(std::vector<Wall> walls)
{
    constexpr double kShare = 0.98;
    std::sort(walls.begin(), walls.end(),
              [](const Wall& a, const Wall& b) { return a.low < b.low; });
    double area = 0;
    double height = 0;
    double done = -kUnbounded;
    for (const Wall& wall : walls) {
        area += wall.angle * (wall.high - wall.low);
        height += std::max(0.0, wall.high - std::max(done, wall.low));
        done = std::max(done, wall.high);
    }
    return area >= kShare * 2 * kPi * height;
}

// True if all of the face lies over or under the hole.
bool is_within(const SampledFace& face, const Wall& hole)
{
    // a level face is a square around its circle
    const double reach = std::sqrt(2.0) * hole.radius + kSameHole;
    return std::all_of(face.samples.begin(), face.samples.end(), [&](const Sample& sample) {
        return norm(in_plan(sample.point) - hole.axis) <= reach;
    });
}

// +1: faces up, -1: faces down, 0: neither everywhere.
int facing(const SampledFace& face)
{
    bool up = true;
    bool down = true;
    for (const Sample& sample : face.samples) {
        const bool pole = norm(sample.normal) == 0;
        up = up && (pole || sample.normal.z > -kUprightAxis);
        down = down && (pole || sample.normal.z < kUprightAxis);
    }
    return up == down ? 0 : up ? 1 : -1;
}

Hole hole_of(const Wall& wall, const std::vector<SampledFace>& faces, bool narrower_below)
{
    constexpr double kDeepestTip = 1.75;  // radii: of a cone of 60 degrees
    Hole::Span span{wall.high, wall.low, !narrower_below};
    for (const SampledFace& face : faces) {
        if (facing(face) > 0 && is_within(face, wall) && face.high <= wall.low + kSameHole &&
            face.low >= wall.low - kDeepestTip * wall.radius - kSameHole) {
            span.bottom = std::min(span.bottom, face.low);
            span.tip = wall.low - span.bottom;
            span.through = false;
        }
    }
    return {wall.axis, 2 * wall.radius, span};
}

// The cone that begins where the wall ends, about its axis.
std::optional<job::HoleMouth> cone_over(const Wall& wall, const std::vector<SampledFace>& faces)
{
    constexpr double kConical = 1e-3;  // mm
    for (const SampledFace& face : faces) {
        if (std::abs(face.low - wall.high) > kSameHole || face.high <= face.low + kSameHole ||
            facing(face) <= 0) {
            continue;
        }
        double widest = 0;
        for (const Sample& sample : face.samples) {
            widest = std::max(widest, norm(in_plan(sample.point) - wall.axis));
        }
        const double slope = (widest - wall.radius) / (face.high - face.low);
        const bool conical =
            slope > 0 &&
            std::all_of(face.samples.begin(), face.samples.end(), [&](const Sample& sample) {
                const double away = norm(in_plan(sample.point) - wall.axis);
                return std::abs(away - wall.radius - slope * (sample.point.z - face.low)) <
                       kConical;
            });
        if (conical) {
            return job::HoleMouth{2 * widest, face.high - face.low,
                                  2 * elementary::atan(slope) * 180 / kPi};
        }
    }
    return std::nullopt;
}

bool is_closed_above(const Wall& wall, const std::vector<SampledFace>& faces)
{
    return std::any_of(faces.begin(), faces.end(), [&](const SampledFace& face) {
        return facing(face) < 0 && is_within(face, wall) && face.low >= wall.high - kSameHole &&
               face.low <= wall.high + kSameHole;
    });
}

}  // namespace

CadHoles holes_of(const CadModel& model)
{
    std::vector<SampledFace> faces;
    std::vector<std::vector<Wall>> groups;
    for (std::size_t k = 0; k < model.faces.size(); ++k) {
        if (model.outwards[k] == 0) {
            continue;
        }
        faces.push_back(sampled(model.faces[k], model.outwards[k]));
        if (const auto wall = wall_of(faces.back())) {
            const auto group = std::find_if(
                groups.begin(), groups.end(),
                [&](const std::vector<Wall>& walls) { return are_one(walls.front(), *wall); });
            if (group == groups.end()) {
                groups.push_back({*wall});
            } else {
                group->push_back(*wall);
            }
        }
    }
    std::vector<Wall> holes;
    for (const std::vector<Wall>& walls : groups) {
        if (is_complete(walls)) {
            holes.push_back(walls.front());
            for (const Wall& wall : walls) {
                holes.back().low = std::min(holes.back().low, wall.low);
                holes.back().high = std::max(holes.back().high, wall.high);
            }
        }
    }
    CadHoles found;
    std::vector<std::pair<Hole, std::optional<job::HoleMouth>>> open;
    for (const std::vector<Wall>& walls : groups) {
        if (!is_complete(walls)) {
            found.corners.push_back(walls.front().radius);
        }
    }
    for (const Wall& hole : holes) {
        const bool narrower_below = std::any_of(holes.begin(), holes.end(), [&](const Wall& other) {
            return norm(other.axis - hole.axis) <= kSameHole && other.radius < hole.radius &&
                   other.low < hole.low - kSameHole;
        });
        if (is_closed_above(hole, faces)) {
            ++found.closed_above;
        } else {
            open.emplace_back(hole_of(hole, faces, narrower_below), cone_over(hole, faces));
        }
    }
    std::sort(open.begin(), open.end(), [](const auto& one, const auto& other) {
        const Hole& a = one.first;
        const Hole& b = other.first;
        return std::tie(a.diameter, a.at.x, a.at.y) < std::tie(b.diameter, b.at.x, b.at.y);
    });
    for (const auto& [hole, cone] : open) {
        found.holes.push_back(hole);
        found.cones.push_back(cone);
    }
    return found;
}

std::vector<Hole> mouths_of(const CadHoles& holes)
{
    std::vector<Hole> mouths = holes.holes;
    for (std::size_t k = 0; k < holes.holes.size(); ++k) {
        if (const auto& cone = holes.cones[k]) {
            const double foot = holes.holes[k].span->top;
            mouths.push_back(
                {holes.holes[k].at, cone->diameter, Hole::Span{foot + cone->depth, foot, false}});
        }
    }
    return mouths;
}

CadHoles read_cad_holes(const std::string& file, const Similarity& placed)
{
    CadModel model = read_cad_model(file);
    for (Surface& face : model.faces) {
        for (Vec3d& point : face.points) {
            point = placed.of(point);
        }
    }
    return holes_of(model);
}

}  // namespace cusp::import
