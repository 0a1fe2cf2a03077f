// Bounds of random rational patches hold at their points, and are not far from what is found there.
#include "host_tools/cam/finishing/wall_cell.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "tests/generators/round_walls.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::test;

namespace {

constexpr int kLooks = 12;
constexpr double kRounding = 1e-9;

// A nearly vertical patch over (x, z), of any degrees, rational or not.
BezierPatch random_patch(Random& random)
{
    BezierPatch out;
    Surface& s = out.surface;
    s.degree_u = whole(random, 1, 4);
    s.degree_v = whole(random, 1, 4);
    s.size_u = s.degree_u + 1;
    s.size_v = s.degree_v + 1;
    out.u_begin = uniform(random, -1.0, 1.0);
    out.u_end = out.u_begin + uniform(random, 0.1, 5.0);
    out.v_begin = uniform(random, -1.0, 1.0);
    out.v_end = out.v_begin + uniform(random, 0.1, 5.0);
    const auto knots = [](int degree, double begin, double end) {
        std::vector<double> at(static_cast<std::size_t>(degree) + 1, begin);
        at.insert(at.end(), static_cast<std::size_t>(degree) + 1, end);
        return at;
    };
    s.knots_u = knots(s.degree_u, out.u_begin, out.u_end);
    s.knots_v = knots(s.degree_v, out.v_begin, out.v_end);
    const bool rational = whole(random, 0, 1) == 0;
    for (int i = 0; i < s.size_u; ++i) {
        for (int j = 0; j < s.size_v; ++j) {
            const double x = 6.0 * i / s.degree_u;
            const double z = 4.0 * j / s.degree_v;
            s.points.push_back({x + uniform(random, -0.2, 0.2), uniform(random, -1.5, 1.5),
                                z + uniform(random, -0.2, 0.2)});
            s.weights.push_back(rational ? uniform(random, 0.5, 1.5) : 2.0);
        }
    }
    return out;
}

struct Part {
    Vec2d low;
    Vec2d high;

    Vec2d at(double s, double t) const
    {
        return {low.x + (high.x - low.x) * s, low.y + (high.y - low.y) * t};
    }
};

Part random_part(Random& random, const BezierPatch& patch)
{
    const double wide = std::pow(2.0, -uniform(random, 0.0, 6.0));
    const double s = uniform(random, 0.0, 1 - wide);
    const double t = uniform(random, 0.0, 1 - wide);
    const double u = patch.u_end - patch.u_begin;
    const double v = patch.v_end - patch.v_begin;
    return {{patch.u_begin + u * s, patch.v_begin + v * t},
            {patch.u_begin + u * (s + wide), patch.v_begin + v * (t + wide)}};
}

struct Seen {
    Vec3d point;
    Vec3d normal;
};

Seen seen_at(const Surface& s, Vec2d uv)
{
    const SurfacePoint p = derivatives_at(s, uv.x, uv.y);
    const Vec3d area = cross(p.du, p.dv);
    return {p.point, area / norm(area)};
}

// The values found at a lattice of places.
struct Found {
    double low{kInfinite};
    double high{-kInfinite};
    double along{};
    double rise{};
    double lines{};
    bool leans{true};
};

Found look(const Surface& s,
           const Part& part,
           const WallCell::Frame& frame,
           const WallCell::Lines& lines,
           double z)
{
    Found out;
    const Vec3d upward = cross(frame.normal, frame.along);
    for (int i = 0; i <= kLooks; ++i) {
        for (int j = 0; j <= kLooks; ++j) {
            const double share_s = static_cast<double>(i) / kLooks;
            const double share_t = static_cast<double>(j) / kLooks;
            const Seen at = seen_at(s, part.at(share_s, share_t));
            const double off = dot(at.point - frame.middle, frame.normal);
            out.low = std::min(out.low, off);
            out.high = std::max(out.high, off);
            const Vec3d way =
                frame.normal +
                frame.along * (frame.bend * dot(at.point - frame.middle, frame.along));
            const double side = dot(at.normal, frame.normal) < 0 ? -1 : 1;
            const Vec3d turned = at.normal * side - way / norm(way);
            out.along = std::max(out.along, std::abs(dot(turned, frame.along)));
            out.rise = std::max(out.rise, std::abs(dot(turned, upward)));
            out.lines =
                std::max(out.lines, std::abs(at.normal.z - lines.low - lines.slope.x * share_s -
                                             lines.slope.y * share_t));
            out.leans = out.leans && std::abs(at.normal.z) > z;
        }
    }
    return out;
}

}  // namespace

TEST_GROUP(WallCell){};

TEST(WallCell, BoundsWhatIsFoundInRandomPatches)
{
    Random random{5};
    int proved = 0;
    int leaning = 0;
    double tightest = 0;
    for (int k = 0; k < 1500; ++k) {
        const BezierPatch patch = random_patch(random);
        const Part part = random_part(random, patch);
        const WallCell cell{patch, part.low, part.high};
        const Seen middle = seen_at(patch.surface, part.at(0.5, 0.5));
        const Vec3d normal = middle.normal.z < 0 ? -middle.normal : middle.normal;
        const Vec3d along = Vec3d{-normal.y, normal.x, 0} / std::hypot(normal.x, normal.y);
        const double side = dot(normal, middle.normal) < 0 ? -1 : 1;
        const WallCell::Frame frame{middle.point, normal, along, uniform(random, -0.2, 0.2)};
        const double z = uniform(random, 0.0, 0.3);
        const double low = seen_at(patch.surface, part.low).normal.z;
        const WallCell::Lines lines{low,
                                    {seen_at(patch.surface, part.at(1, 0)).normal.z - low,
                                     seen_at(patch.surface, part.at(0, 1)).normal.z - low}};
        const Found found = look(patch.surface, part, frame, lines, z);
        const auto [off_low, off_high] = cell.along(frame.middle, frame.normal);
        CHECK(off_low <= found.low + kRounding);
        CHECK(off_high >= found.high - kRounding);
        if (cell.leans_more_than(z)) {
            CHECK(found.leans);
            ++leaning;
        }
        const auto turn = cell.turn(frame, lines, side);
        if (turn) {
            CHECK(turn->along >= found.along - kRounding);
            CHECK(turn->rise >= found.rise - kRounding);
            CHECK(turn->lines >= found.lines - kRounding);
            tightest = std::max(tightest, found.along / turn->along);
            ++proved;
        }
    }
    CHECK(proved > 500);
    CHECK(leaning > 100);
    CHECK(tightest > 0.5);
}

TEST(WallCell, BoundsHowFarSidesBow)
{
    Random random{6};
    for (int k = 0; k < 500; ++k) {
        const BezierPatch patch = random_patch(random);
        const Part part = random_part(random, patch);
        const WallCell cell{patch, part.low, part.high};
        const WallCell::Frame frame{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, 0};
        const Vec2d from{uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0)};
        const Vec2d to{uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0)};
        const double bow = cell.bends(frame).bow(to - from);
        const auto at = [&](double share) {
            const Vec2d place = from + (to - from) * share;
            const Vec2d uv = part.at(place.x, place.y);
            const Vec3d p = point_at(patch.surface, uv.x, uv.y);
            return Vec2d{p.x, p.z};
        };
        for (int i = 1; i < kLooks; ++i) {
            const double share = static_cast<double>(i) / kLooks;
            const Vec2d off = at(share) - at(0) * (1 - share) - at(1) * share;
            CHECK(std::hypot(off.x, off.y) <= bow + kRounding);
        }
    }
}

// A vertical cylinder: nothing of its lean is lost in bounds, and turning evenly is within the third
// order.
TEST(WallCell, IsTightOnACylinder)
{
    const RoundWall wall{{1, 2}, {0.3, 1.5}, 0, 40, {5, 5, 5}};
    const BezierPatch patch = bezier_patches(wall.surface()).front();
    const Part part{{0.5, 0}, {0.5 + 1.0 / 32, 1}};
    const WallCell cell{patch, part.low, part.high};
    const Seen middle = seen_at(patch.surface, part.at(0.5, 0.5));
    const Vec3d along{-middle.normal.y, middle.normal.x, 0};
    const auto turn = cell.turn({middle.point, middle.normal, along, 1.0 / 5}, {0, {0, 0}}, 1);
    CHECK(turn.has_value());
    const double half = 0.5 * 1.2 / 32;  // radians, about
    CHECK(turn->rise < 1e-12);
    CHECK(turn->lines < 1e-12);
    CHECK(turn->most < 1.3 * half);
    CHECK(turn->along < half * half);
    const auto [low, high] = cell.along(middle.point, middle.normal);
    CHECK(high - low < 1.3 * 2 * 5 * 0.5 * half * half);
}

// A ball's pole is a side of its patch. Its normals turn away from there as elsewhere.
TEST(WallCell, ProvesNormalsAtAPole)
{
    const double root = std::sqrt(0.5);
    BezierPatch patch;
    Surface& s = patch.surface;
    s.degree_u = s.degree_v = 2;
    s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
    s.size_u = s.size_v = 3;
    const Vec3d round[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (int i = 0; i < 3; ++i) {
        const Vec3d way = round[i];
        s.points.insert(s.points.end(), {way, way + Vec3d{0, 0, 1}, {0, 0, 1}});
        const double by = i == 1 ? root : 1;
        s.weights.insert(s.weights.end(), {by, by * root, by});
    }
    patch.u_begin = patch.v_begin = 0;
    patch.u_end = patch.v_end = 1;
    CHECK((WallCell{patch, {0, 0.75}, {1, 1}}.leans_more_than(0.5)));
    CHECK_FALSE((WallCell{patch, {0, 0}, {1, 1}}.leans_more_than(0.05)));
}
