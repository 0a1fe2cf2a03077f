// Random faces of spheres, each the part of a sphere on one side of some planes: every point of the
// sphere lies in one patch if it is on that side of all of them, and in none otherwise.
//
// CUSP_PROPERTY_FIRST and CUSP_PROPERTY_CASES: the seeds. Each failure names its seed.
#include <algorithm>
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/sphere_patches.hpp"
#include "tests/generators/draw.hpp"
#include "tests/judges/patch_cover.hpp"
#include "tests/support/property_cases.hpp"

#include "fmt/format.h"

using namespace cusp;
using namespace cusp::import;
using cusp::test::Draw;

namespace {

// The part of the unit sphere with normal . p <= height stays.
struct Side {
    Vec3d normal;
    double height;
    Vec3d across;  // with `up` and the normal a right-handed frame
    Vec3d up;

    double radius() const { return std::sqrt(1 - height * height); }
    Vec3d at(double angle) const
    {
        return normal * height + (across * std::cos(angle) + up * std::sin(angle)) * radius();
    }
    bool keeps(Vec3d p) const { return dot(normal, p) <= height; }
};

Vec3d random_direction(Draw& draw)
{
    const double z = draw.uniform(-1, 1);
    const double angle = draw.uniform(-kPi, kPi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

std::vector<Side> random_sides(Draw& draw)
{
    std::vector<Side> sides(static_cast<std::size_t>(draw.whole(1, 5)));
    for (Side& side : sides) {
        side.normal = random_direction(draw);
        side.height = draw.whole(0, 3) == 0 ? 0 : draw.uniform(-0.6, 0.95);
        const Vec3d beside = random_direction(draw);
        const Vec3d across = cross(side.normal, beside);
        side.across = across / norm(across);
        side.up = cross(side.normal, side.across);
    }
    return sides;
}

// The angles at which the circle of a side meets the plane of another one.
void add_meetings(const Side& side, const Side& other, std::vector<double>& angles)
{
    const double a = dot(other.normal, side.across) * side.radius();
    const double b = dot(other.normal, side.up) * side.radius();
    const double c = other.height - dot(other.normal, side.normal) * side.height;
    const double most = std::hypot(a, b);
    if (std::abs(c) < most) {
        for (const double sign : {-1.0, 1.0}) {
            const double angle = std::atan2(b, a) + sign * std::acos(c / most);
            angles.push_back(angle - 2 * kPi * std::floor(angle / (2 * kPi)));
        }
    }
}

// The edges of what all sides keep, on a sphere; some run against their parameter.
std::vector<FaceEdge> edges_of(const std::vector<Side>& sides, const Sphere& sphere)
{
    std::vector<FaceEdge> edges;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        std::vector<double> angles;
        for (std::size_t j = 0; j < sides.size(); ++j) {
            if (j != i) {
                add_meetings(sides[i], sides[j], angles);
            }
        }
        std::sort(angles.begin(), angles.end());
        if (angles.empty()) {
            angles.push_back(0.3);
        }
        angles.push_back(angles.front() + 2 * kPi);
        for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
            const Vec3d middle = sides[i].at(0.5 * (angles[k] + angles[k + 1]));
            bool kept = true;
            for (std::size_t j = 0; j < sides.size(); ++j) {
                kept = kept && (j == i || sides[j].keeps(middle));
            }
            if (!kept) {
                continue;
            }
            const auto curve = [side = sides[i], sphere](double t) {
                return PointAndTangent{sphere.centre + side.at(t) * sphere.radius,
                                       (side.up * std::cos(t) - side.across * std::sin(t)) *
                                           (side.radius() * sphere.radius)};
            };
            // counter-clockwise about the normal has what lies beyond the plane on its left
            edges.push_back({curve, angles[k + 1], angles[k]});
            if (i % 2 == 1) {
                const auto turned = [curve](double t) {
                    const PointAndTangent at = curve(-t);
                    return PointAndTangent{at.point, -at.tangent};
                };
                edges.back() = {turned, -angles[k + 1], -angles[k]};
            }
        }
    }
    return edges;
}

// Trims are chords here.
bool is_near_a_side(const std::vector<Side>& sides, Vec3d p)
{
    constexpr double kNear = 1e-3;
    return std::any_of(sides.begin(), sides.end(), [&](const Side& side) {
        return std::abs(dot(side.normal, p) - side.height) < kNear;
    });
}

std::string wrong_of(unsigned seed)
{
    constexpr int kPoints = 60;
    Draw draw{std::mt19937{seed}};
    const Sphere sphere{{draw.uniform(-50, 50), draw.uniform(-50, 50), draw.uniform(-50, 50)},
                        draw.uniform(0.5, 60)};
    const std::vector<Side> sides = random_sides(draw);
    const std::vector<FaceEdge> edges = edges_of(sides, sphere);
    if (edges.empty()) {
        return {};  // nothing is kept
    }
    test::PatchCover cover;
    try {
        cover = test::PatchCover{sphere_patches(sphere, edges, 1e-6, "a face")};
    } catch (const InputError& error) {
        return fmt::format("seed {}: {}", seed, error.what());
    }
    for (int k = 0; k < kPoints; ++k) {
        const Vec3d p = random_direction(draw);
        if (is_near_a_side(sides, p)) {
            continue;
        }
        const bool kept = std::all_of(sides.begin(), sides.end(),
                                      [&](const Side& side) { return side.keeps(p); });
        // patches meet within their trims' tolerance: a point between two of them is moved
        const Vec3d beside = p + random_direction(draw) * 1e-4;
        const auto held = cover.patches_at(sphere.centre + p * sphere.radius);
        if (held != (kept ? 1 : 0) &&
            cover.patches_at(sphere.centre + beside * (sphere.radius / norm(beside))) !=
                (kept ? 1 : 0)) {
            return fmt::format("seed {}: {} patches hold ({} {} {}), {} expected", seed, held, p.x,
                               p.y, p.z, kept ? 1 : 0);
        }
    }
    return {};
}

}  // namespace

TEST_GROUP(SpherePatchesProperty){};

TEST(SpherePatchesProperty, CoverAFaceOnce)
{
    const std::string wrong =
        test::broken_cases(test::property_seed(1), test::property_cases(400), wrong_of);
    STRCMP_EQUAL("", wrong.c_str());
}
