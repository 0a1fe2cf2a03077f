// Random faces of rings and cones, bounded by lines in (u, v) at any turn: every point of the surface lies in
// one patch if it is on the face, and in none otherwise.
//
// CUSP_PROPERTY_FIRST and CUSP_PROPERTY_CASES: the seeds. Each failure names its seed.
#include <algorithm>
#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/revolved_patches.hpp"
#include "tests/generators/draw.hpp"
#include "tests/judges/patch_cover.hpp"
#include "tests/support/property_cases.hpp"

#include "fmt/format.h"

using namespace cusp;
using namespace cusp::import;
using cusp::test::Draw;

namespace {

Vec3d point_on(const Revolved& surface, Vec2d uv)
{
    const Vec2d at = surface.profile(uv.y);
    return surface.origin +
           (surface.axes[0] * std::cos(uv.x) + surface.axes[1] * std::sin(uv.x)) * at.x +
           surface.axes[2] * at.y;
}

// By u and by v.
std::array<Vec3d, 2> slopes_on(const Revolved& surface, Vec2d uv)
{
    const Vec3d out = surface.axes[0] * std::cos(uv.x) + surface.axes[1] * std::sin(uv.x);
    const Vec3d around = surface.axes[1] * std::cos(uv.x) - surface.axes[0] * std::sin(uv.x);
    const Vec3d along =
        surface.is_ring()
            ? (surface.axes[2] * std::cos(uv.y) - out * std::sin(uv.y)) * surface.tube
            : out * std::sin(surface.slope) + surface.axes[2] * std::cos(surface.slope);
    return {around * surface.profile(uv.y).x, along};
}

Revolved random_surface(Draw& draw, bool ring)
{
    const double z = draw.uniform(-1, 1);
    const double angle = draw.uniform(-kPi, kPi);
    const double r = std::sqrt(1 - z * z);
    const Vec3d x{r * std::cos(angle), r * std::sin(angle), z};
    const Vec3d beside = cross(x, std::abs(z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0});
    const Vec3d y = beside / norm(beside);
    const double tube = draw.uniform(0.5, 10);
    Revolved surface{{draw.uniform(-50, 50), draw.uniform(-50, 50), draw.uniform(-50, 50)},
                     {x, y, cross(x, y)},
                     0,
                     ring ? tube : 0,
                     0};
    surface.radius = ring ? tube * draw.uniform(1.1, 8) : draw.uniform(5, 30);
    surface.slope = ring || draw.whole(0, 2) == 0 ? 0 : draw.uniform(-0.7, 0.7);
    return surface;
}

// A closed line in (u, v), which may run round the surface: the last corner is the first one, whole turns
// further.
using Corners = std::vector<Vec2d>;

// Some edges run against their parameter, and some have a tangent that jumps at their end.
void add_edges(const Revolved& surface, const Corners& corners, std::vector<FaceEdge>& edges)
{
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
        const Vec2d a = corners[k];
        const Vec2d by = corners[k + 1] - a;
        const auto curve = [&surface, a, by, jumps = k % 5 == 1](double t) {
            const Vec2d at = a + by * t;
            const auto [by_u, by_v] = slopes_on(surface, at);
            const double jump = jumps && t > 1 - 1e-9 ? 3000 : 1;
            return PointAndTangent{point_on(surface, at), (by_u * by.x + by_v * by.y) * jump};
        };
        if (k % 3 == 2) {
            const auto turned = [curve](double t) {
                const PointAndTangent at = curve(1 - t);
                return PointAndTangent{at.point, -at.tangent};
            };
            edges.push_back({turned, 1, 0});
        } else {
            edges.push_back({curve, 0, 1});
        }
    }
}

// Counter-clockwise about a place, no two corners half a turn apart; v of a line is stretched.
Corners star(Draw& draw, Vec2d middle, double stretch)
{
    const int count = draw.whole(4, 9);
    const double most = draw.uniform(0.3, 2.7);
    Corners corners;
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * kPi * (k + draw.uniform(-0.3, 0.3)) / count;
        const double r = most * draw.uniform(0.35, 1);
        corners.push_back(middle + Vec2d{r * std::cos(angle), stretch * r * std::sin(angle)});
    }
    corners.push_back(corners.front());
    return corners;
}

// Round the axis (0) or the tube (1) near a height.
Corners belt(Draw& draw, int way, double height, double wave)
{
    constexpr int kCount = 7;
    const double start = draw.uniform(-kPi, kPi);
    Corners corners;
    for (int k = 0; k < kCount; ++k) {
        const double along = start + 2 * kPi * (k + draw.uniform(-0.3, 0.3)) / kCount;
        const double beside = height + wave * draw.uniform(-1, 1);
        corners.push_back(way == 0 ? Vec2d{along, beside} : Vec2d{beside, along});
    }
    corners.push_back(corners.front() + (way == 0 ? Vec2d{2 * kPi, 0} : Vec2d{0, 2 * kPi}));
    return corners;
}

double wrapped(double angle) { return angle - 2 * kPi * std::floor(angle / (2 * kPi) + 0.5); }

bool within(const Corners& loop, Vec2d p)
{
    bool inside = false;
    for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
        const Vec2d a = loop[k];
        const Vec2d b = loop[k + 1];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) {
            inside = !inside;
        }
    }
    return inside;
}

struct Case {
    Revolved surface;
    std::vector<Corners> lines;
    int kind;  // 0: within a star, 1: the rest of a ring, 2: between two belts, 3: a star within belts is cut out
    int way;  // of belts
    Vec2d middle;

    // Place of a belt at `across` along it.
    static double belt_at(const Corners& belt, int way, double along)
    {
        for (std::size_t k = 0; k + 1 < belt.size(); ++k) {
            const double from = way == 0 ? belt[k].x : belt[k].y;
            const double to = way == 0 ? belt[k + 1].x : belt[k + 1].y;
            const double turned =
                from + (along - from) - 2 * kPi * std::floor((along - from) / (2 * kPi));
            if (turned <= to) {
                const double t = (turned - from) / (to - from);
                return way == 0 ? belt[k].y * (1 - t) + belt[k + 1].y * t
                                : belt[k].x * (1 - t) + belt[k + 1].x * t;
            }
        }
        return 0;
    }
    bool in_star(const Corners& loop, Vec2d uv) const
    {
        const Vec2d by{wrapped(uv.x - middle.x),
                       surface.is_ring() ? wrapped(uv.y - middle.y) : uv.y - middle.y};
        return within(loop, middle + by);
    }
    bool keeps(Vec2d uv) const
    {
        if (kind < 2) {
            return in_star(lines[0], uv) != (kind == 1);
        }
        const double along = way == 0 ? uv.x : uv.y;
        const double low = belt_at(lines[0], way, along);
        const double high = belt_at(lines[1], way, along);
        const double at = way == 0 ? uv.y : uv.x;
        const double above = surface.is_ring() || way == 1
                                 ? at - low - 2 * kPi * std::floor((at - low) / (2 * kPi))
                                 : at - low;
        return above > 0 && above < high - low && (kind == 2 || !in_star(lines[2], uv));
    }
};

Corners reversed_of(Corners corners)
{
    std::reverse(corners.begin(), corners.end());
    return corners;
}

Case random_case(Draw& draw)
{
    const bool ring = draw.whole(0, 2) > 0;
    Case made{random_surface(draw, ring), {}, 0, 0, {}};
    // of a cone, v within some millimetres of its middle, which keep it off the axis
    const double stretch = ring ? 1 : made.surface.radius / 4;
    made.middle = {draw.uniform(-kPi, kPi), ring ? draw.uniform(-kPi, kPi) : 0};
    const std::array<int, 3> of_cone{0, 2, 3};
    made.kind = ring ? draw.whole(0, 3) : of_cone[static_cast<std::size_t>(draw.whole(0, 2))];
    if (made.kind < 2) {
        const Corners loop = star(draw, made.middle, stretch);
        made.lines.push_back(made.kind == 0 ? loop : reversed_of(loop));
        return made;
    }
    made.way = ring ? draw.whole(0, 1) : 0;
    const double half = draw.uniform(0.6, 2.6);
    const double centre = made.way == 0 ? made.middle.y : made.middle.x;
    Corners low = belt(draw, made.way, centre - half * stretch, 0.4 * stretch);
    Corners high = belt(draw, made.way, centre + half * stretch, 0.4 * stretch);
    made.lines = {low, high};
    if (made.kind == 3) {
        Corners loop = star(draw, made.middle, stretch);
        for (Vec2d& corner : loop) {
            corner = made.middle + (corner - made.middle) * (0.15 / 2.7);
        }
        made.lines.push_back(loop);
    }
    return made;
}

std::vector<FaceEdge> edges_of(const Case& made)
{
    std::vector<FaceEdge> edges;
    if (made.kind < 2) {
        add_edges(made.surface, made.lines[0], edges);
        return edges;
    }
    // what is between the belts is on the left of the low one where belts run along u, of the high one along v
    const std::size_t straight = made.way == 0 ? 0 : 1;
    add_edges(made.surface, made.lines[straight], edges);
    add_edges(made.surface, reversed_of(made.lines[1 - straight]), edges);
    if (made.kind == 3) {
        add_edges(made.surface, reversed_of(made.lines[2]), edges);
    }
    return edges;
}

std::string wrong_of(unsigned seed)
{
    constexpr int kPoints = 40;
    Draw draw{std::mt19937{seed}};
    const Case made = random_case(draw);
    test::PatchCover cover;
    try {
        cover = test::PatchCover{revolved_patches(made.surface, edges_of(made), 1e-6, "a face")};
    } catch (const InputError& error) {
        return fmt::format("seed {}: kind {}: {}", seed, made.kind, error.what());
    }
    const double stretch = made.surface.is_ring() ? 1 : made.surface.radius / 4;
    for (int k = 0; k < kPoints; ++k) {
        const Vec2d uv{draw.uniform(-kPi, kPi), stretch * draw.uniform(-3, 3)};
        const bool kept = made.keeps(uv);
        bool near_a_line = false;
        for (const double du : {-1e-3, 1e-3}) {
            for (const double dv : {-1e-3, 1e-3}) {
                near_a_line = near_a_line || made.keeps(uv + Vec2d{du, dv * stretch}) != kept;
            }
        }
        if (near_a_line) {
            continue;
        }
        // patches meet within their trims' tolerance: a point between two of them is moved
        const auto held = cover.patches_at(point_on(made.surface, uv));
        const Vec2d beside = uv + Vec2d{1e-4, 1e-4 * stretch};
        if (held != (kept ? 1 : 0) &&
            cover.patches_at(point_on(made.surface, beside)) != (kept ? 1 : 0)) {
            return fmt::format("seed {}: kind {} way {}: {} patches hold u {} v {}, {} expected",
                               seed, made.kind, made.way, held, uv.x, uv.y, kept ? 1 : 0);
        }
    }
    return {};
}

}  // namespace

TEST_GROUP(RevolvedPatchesProperty){};

TEST(RevolvedPatchesProperty, CoverAFaceOnce)
{
    const std::string wrong =
        test::broken_cases(test::property_seed(1), test::property_cases(400), wrong_of);
    STRCMP_EQUAL("", wrong.c_str());
}

TEST(RevolvedPatchesProperty, CoverAWholeRing)
{
    const Revolved ring{{1, 2, 3}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 10, 3, 0};
    const test::PatchCover cover{revolved_patches(ring, {}, 1e-6, "a ring")};
    Draw draw{std::mt19937{1}};
    for (int k = 0; k < 200; ++k) {
        const double u = draw.uniform(-kPi, kPi);
        LONGS_EQUAL(1, cover.patches_at(point_on(ring, {u, draw.uniform(-kPi, kPi)})));
    }
}
