// 2.5-D operations on random outlines, judged by distances from segments and by heights over
// points, both by brute force.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/draw.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/test_jobs.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace prismatic;
using job::Job;
using job::Operation;
using job::Prismatic;
using job::ProfileSide;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::ToolShape;

namespace {

constexpr double kExact = 1e-3;  // mm: accuracy of a profile

// Prints the seed, to repeat a failure.
Draw seeded(const char* what, unsigned seed, int cases)
{
    std::printf("%s: seed %u, %d cases\n", what, seed, cases);
    return {std::mt19937{seed}};
}

double from_segment(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double share = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
    return norm(p - (a + share * along));
}

double from_outline(Vec2d p, const std::vector<Vec2d>& corners)
{
    double least = kUnbounded;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        least = std::min(least, from_segment(p, corners[i], corners[(i + 1) % corners.size()]));
    }
    return least;
}

bool is_inside(Vec2d p, const std::vector<Vec2d>& corners)
{
    bool inside = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2d a = corners[i];
        const Vec2d b = corners[(i + 1) % corners.size()];
        if ((a.y <= p.y) != (b.y <= p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) {
            inside = !inside;
        }
    }
    return inside;
}

// Around the origin; `uneven`: 0 for a convex outline on a circle.
std::vector<Vec2d> random_outline(Draw& draw, double uneven)
{
    std::vector<double> angles;
    const int n = draw.whole(3, 12);
    const double turn = draw.uniform(0, 2 * kPi);
    for (int i = 0; i < n; ++i) {
        angles.push_back(turn + 2 * kPi * (i + draw.uniform(-0.3, 0.3)) / n);
    }
    std::vector<Vec2d> corners;
    for (const double angle : angles) {
        const double r = 30 * (1 - uneven * draw.uniform(0, 1));
        corners.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return corners;
}

Operation cut_of(const job::Strategy& strategy, double depth)
{
    Operation operation;
    operation.strategy = &strategy;
    operation.tool = {1, ToolShape::kFlat, 3.0, 0.0};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.output = job::OutputForm::kArcs;
    operation.prismatic.emplace();
    operation.prismatic->depth = depth;
    return operation;
}

Operation profile_of(const std::vector<Vec2d>& corners, double radius)
{
    Operation operation = cut_of(cusp::prismatic::kProfile, 4.0);
    operation.tool.radius = radius;
    operation.prismatic->loops = {{loop_of(corners), "outline", false}};
    return operation;
}

struct Place {
    Vec3d tip;
    MoveKind kind;
};

// All places of the tip, chords within `tolerance`, no farther apart than `apart`.
std::vector<Place> places_of(const PlannedOperation& planned, double tolerance, double apart)
{
    std::vector<Place> places;
    Vec3d at{0, 0, 100};
    for (const ToolMove& move : planned.path.moves) {
        for (const Vec3d p : points_of(move, at, tolerance)) {
            const int pieces = std::max(1, static_cast<int>(std::ceil(norm(p - at) / apart)));
            for (int i = 1; i <= pieces; ++i) {
                places.push_back({at + (p - at) * (static_cast<double>(i) / pieces), move.kind});
            }
            at = p;
        }
    }
    return places;
}

// Every place of the path is at its distance from the outline; every place at that distance, on the
// right side, is on the path.
void check_profile(Draw& draw, bool with_leads)
{
    const std::vector<Vec2d> corners = random_outline(draw, draw.uniform(0, 0.6));
    const double radius = draw.uniform(0.3, 4.0);
    Operation operation = profile_of(corners, radius);
    const bool outside = draw.whole(0, 1) == 0;
    operation.prismatic->side = outside ? ProfileSide::kOutside : ProfileSide::kInside;
    operation.output = draw.whole(0, 1) == 0 ? job::OutputForm::kArcs : job::OutputForm::kLines;
    operation.passes.direction_of_cut =
        draw.whole(0, 1) == 0 ? job::CutDirection::kClimb : job::CutDirection::kConventional;
    if (!with_leads) {
        operation.prismatic->lead_in = 0.0;
    }
    const double allowed =
        kExact + (operation.output == job::OutputForm::kLines ? operation.tolerance.plan : 0.0);
    std::vector<Place> places;
    try {
        places = places_of(plan_profile(plain_job(), operation).front(), 1e-4, 0.2);
    } catch (const InputError&) {
        // the tool fits nowhere: no place of the outline's inside is as far from it
        CHECK_FALSE(outside);
        for (int i = 0; i < 300; ++i) {
            const Vec2d p{draw.uniform(-30, 30), draw.uniform(-30, 30)};
            CHECK_FALSE(is_inside(p, corners) && from_outline(p, corners) > radius + kExact);
        }
        return;
    }
    std::vector<Vec2d> cut;
    for (const Place& place : places) {
        if (place.tip.z < 0) {
            const Vec2d p = in_plan(place.tip);
            const double away = from_outline(p, corners);
            CHECK(is_inside(p, corners) != outside);
            CHECK(away >= radius - kExact);
            // a ramp goes along lines in place of arcs
            const double ramp = place.kind == MoveKind::kPlunge ? operation.tolerance.plan : 0.0;
            CHECK(with_leads || away <= radius + allowed + ramp);
            cut.push_back(p);
        }
    }
    for (int i = 0; i < 40; ++i) {
        const auto side =
            static_cast<std::size_t>(draw.whole(0, static_cast<int>(corners.size()) - 1));
        const Vec2d a = corners[side];
        const Vec2d b = corners[(side + 1) % corners.size()];
        const Vec2d t = (b - a) * (1 / norm(b - a));
        const Vec2d left{-t.y, t.x};  // into the outline
        const Vec2d p = a + (b - a) * draw.uniform(0, 1) + left * (outside ? -radius : radius);
        if (from_outline(p, corners) < radius - 1e-9 || is_inside(p, corners) == outside) {
            continue;
        }
        double least = kUnbounded;
        for (const Vec2d c : cut) {
            least = std::min(least, norm(c - p));
        }
        CHECK(least <= 0.1 + allowed);  // half of the distance between samples
    }
}

TEST_GROUP(PrismaticProperty){};

TEST(PrismaticProperty, ProfilesKeepTheirDistanceToAMicrometreAndLeaveNothingOut)
{
    const int cases = property_cases(1000);
    Draw draw = seeded("profiles", 28, cases);
    for (int i = 0; i < cases; ++i) {
        check_profile(draw, i % 2 == 0);
    }
}

// Along a convex outline, which the tool reaches everywhere, the heights of the stock beside it are
// sampled: only the tabs are left.
TEST(PrismaticProperty, TabsStandAsManyAsHighAndAsWideAsAskedFor)
{
    const int cases = property_cases(100);
    Draw draw = seeded("tabs", 4, cases);
    for (int i = 0; i < cases; ++i) {
        const std::vector<Vec2d> corners = random_outline(draw, 0.0);
        Operation operation = profile_of(corners, draw.uniform(0.5, 3.0));
        operation.levels.max_depth = draw.uniform(0.7, 5.0);
        operation.passes.allowance = draw.whole(0, 1) * 0.2;
        job::Tabs tabs{draw.whole(1, 4),
                       {},
                       draw.uniform(2, 6),
                       draw.uniform(0.3, 2.0),
                       draw.whole(0, 1) == 0};
        operation.prismatic->tabs = tabs;
        const double radius = operation.tool.radius;
        const std::vector<Place> places =
            places_of(plan_profile(plain_job(), operation).front(), 1e-3, 0.1);
        const double full = -4.0 + tabs.height;
        const double bottom = -4.0;
        constexpr double kApart = 0.2;  // mm along the outline
        std::vector<double> heights;
        for (std::size_t n = 0; n < corners.size(); ++n) {
            const Vec2d a = corners[n];
            const Vec2d b = corners[(n + 1) % corners.size()];
            const Vec2d t = (b - a) * (1 / norm(b - a));
            const Vec2d out{t.y, -t.x};
            const int pieces = static_cast<int>(norm(b - a) / kApart);
            for (int k = 0; k < pieces; ++k) {
                const Vec2d p = a + (b - a) * (static_cast<double>(k) / pieces) + out * 0.01;
                double lowest = 0;
                for (const Place& place : places) {
                    const Vec2d d = in_plan(place.tip) - p;
                    if (place.tip.z < lowest && dot(d, d) <= radius * radius) {
                        lowest = place.tip.z;
                    }
                }
                heights.push_back(lowest);
            }
        }
        int standing = 0;
        std::size_t begin = 0;
        while (begin < heights.size() && heights[begin] >= full - kExact) {
            ++begin;  // where a tab lies over the first corner, begin behind it
        }
        std::rotate(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(begin),
                    heights.end());
        std::vector<double> widths;
        std::size_t run = 0;
        for (const double z : heights) {
            CHECK(z <= full + kExact);  // nothing is left higher than a tab
            CHECK(z >= bottom - kExact);
            run = z >= full - kExact ? run + 1 : 0;
            standing += run == 1 ? 1 : 0;
            if (run == 1) {
                widths.push_back(0);
            }
            if (run > 0) {
                widths.back() += kApart;
            }
        }
        LONGS_EQUAL(tabs.count, standing);
        for (const double width : widths) {
            // around a corner the outline is shorter than the path beside it
            CHECK(width >= 0.25 * tabs.width);
            CHECK(width <= tabs.width + 2 * radius + 0.5);
        }
    }
}

TEST(PrismaticProperty, HolesAreDrilledWhereTheyAreAndOnce)
{
    const int cases = property_cases(2000);
    Draw draw = seeded("holes", 83, cases);
    for (int i = 0; i < cases; ++i) {
        Operation operation = cut_of(cusp::prismatic::kDrill, draw.uniform(0.5, 20));
        const int count = draw.whole(1, 30);
        for (int k = 0; k < count; ++k) {
            operation.prismatic->holes.push_back(
                {{draw.uniform(-50, 50), draw.uniform(-50, 50)}, 0.0});
        }
        const double peck = draw.uniform(0.3, 10);
        if (draw.whole(0, 1) == 0) {
            operation.prismatic->peck = peck;
        }
        const PlannedOperation planned = plan_drill(plain_job(), operation).front();
        std::multiset<std::pair<double, double>> bottoms;
        Vec3d at{0, 0, 100};
        double deepest = 0;  // of the hole at hand
        for (const ToolMove& move : planned.path.moves) {
            const Vec3d end = end_of(move);
            const bool moved = end.x != at.x || end.y != at.y;
            CHECK(!moved || (at.z >= 5 && end.z >= 5));  // sideways above the stock alone
            deepest = moved ? 0 : deepest;
            if (move.kind == MoveKind::kRapid) {
                CHECK(end.z > deepest || end.z > 0);  // never into stock beside the hole
            } else if (end.z < deepest) {
                CHECK(!operation.prismatic->peck || deepest - end.z <= peck * 1.001 + 1e-9);
                deepest = end.z;
                if (std::abs(end.z + operation.prismatic->depth) < 1e-9) {
                    bottoms.insert({end.x, end.y});
                }
            }
            at = end;
        }
        LONGS_EQUAL(count, bottoms.size());
        for (const job::Hole& hole : operation.prismatic->holes) {
            CHECK(bottoms.count({hole.at.x, hole.at.y}) > 0);
        }
    }
}

TEST(PrismaticProperty, ToursVisitEveryPlaceAndAreNoLongerThanTheNearestNext)
{
    const int cases = property_cases(1000);
    Draw draw = seeded("tours", 2, cases);
    for (int i = 0; i < cases; ++i) {
        std::vector<Vec2d> places(static_cast<std::size_t>(draw.whole(1, 40)));
        for (Vec2d& p : places) {
            p = {draw.uniform(0, 100), draw.uniform(0, 100)};
        }
        const std::vector<std::size_t> order = toolpath::short_tour(places, {0, 0});
        CHECK(std::set<std::size_t>(order.begin(), order.end()).size() == places.size());
        double way = 0;
        Vec2d at{0, 0};
        for (const std::size_t k : order) {
            way += norm(places[k] - at);
            at = places[k];
        }
        std::vector<Vec2d> rest = places;
        double greedy = 0;
        for (at = {0, 0}; !rest.empty();) {
            const auto next = std::min_element(rest.begin(), rest.end(), [&](Vec2d a, Vec2d b) {
                return norm(a - at) < norm(b - at);
            });
            greedy += norm(*next - at);
            at = *next;
            rest.erase(next);
        }
        CHECK(way <= greedy + 1e-6);
    }
}

TEST(PrismaticProperty, FacesLeaveNoPlaceOfTheStock)
{
    const int cases = property_cases(1000);
    Draw draw = seeded("faces", 9, cases);
    for (int i = 0; i < cases; ++i) {
        Operation operation = cut_of(cusp::prismatic::kFace, draw.uniform(0.1, 3));
        operation.tool.radius = draw.uniform(1, 12);
        operation.passes.traversal =
            draw.whole(0, 1) == 0 ? job::Traversal::kZigzag : job::Traversal::kOneWay;
        Job job = plain_job();
        job.stock_x = {draw.uniform(-50, 0), draw.uniform(10, 80)};
        job.stock_y = {draw.uniform(-50, 0), draw.uniform(10, 80)};
        const PlannedOperation planned = plan_face(job, operation).front();
        std::vector<std::array<Vec2d, 2>> cuts;
        Vec3d at{0, 0, 100};
        for (const ToolMove& move : planned.path.moves) {
            const Vec3d end = end_of(move);
            if (at.z == -operation.prismatic->depth && end.z == at.z) {
                cuts.push_back({in_plan(at), in_plan(end)});
            }
            at = end;
        }
        for (int k = 0; k < 50; ++k) {
            const Vec2d p{draw.uniform((*job.stock_x)[0], (*job.stock_x)[1]),
                          draw.uniform((*job.stock_y)[0], (*job.stock_y)[1])};
            CHECK(std::any_of(cuts.begin(), cuts.end(), [&](const auto& cut) {
                return from_segment(p, cut[0], cut[1]) <= operation.tool.radius + 1e-9;
            }));
        }
    }
}

// In both directions: the tip never leaves the lines, and visits all of them.
TEST(PrismaticProperty, EngravingFollowsItsLines)
{
    const int cases = property_cases(1000);
    Draw draw = seeded("engraving", 5, cases);
    for (int i = 0; i < cases; ++i) {
        const std::vector<Vec2d> corners = random_outline(draw, 0.8);
        Operation operation = cut_of(cusp::prismatic::kEngrave, 0.3);
        operation.prismatic->chains = {loop_of(corners)};
        std::vector<Vec2d> cut;
        for (const Place& place :
             places_of(plan_engrave(plain_job(), operation).front(), 1e-4, 0.2)) {
            if (place.tip.z < 0) {
                CHECK(from_outline(in_plan(place.tip), corners) <= kExact);
                cut.push_back(in_plan(place.tip));
            }
        }
        for (int k = 0; k < 20; ++k) {
            const auto side =
                static_cast<std::size_t>(draw.whole(0, static_cast<int>(corners.size()) - 1));
            const Vec2d a = corners[side];
            const Vec2d p = a + (corners[(side + 1) % corners.size()] - a) * draw.uniform(0, 1);
            CHECK(std::any_of(cut.begin(), cut.end(),
                              [&](Vec2d c) { return norm(c - p) <= 0.1 + kExact; }));
        }
    }
}

// The lowest flank over places beside an edge of a convex outline.
TEST(PrismaticProperty, ChamfersHaveTheirWidthAndSlope)
{
    const int cases = property_cases(150);
    Draw draw = seeded("chamfers", 45, cases);
    for (int i = 0; i < cases; ++i) {
        const std::vector<Vec2d> corners = random_outline(draw, 0.0);
        Operation operation = cut_of(cusp::prismatic::kChamfer, 1.0);
        operation.tool = {1,   ToolShape::kVee,        5.0,
                          0.0, draw.uniform(0.5, 2.0), draw.whole(0, 1) * 0.3};
        operation.prismatic->width = draw.uniform(0.2, 2.0);
        operation.prismatic->loops = {{loop_of(corners), "outline", false}};
        const double slope = 1 / std::tan(operation.tool.tip_angle / 2);
        const std::vector<Place> places =
            places_of(plan_chamfer(plain_job(), operation).front(), 1e-4, 0.02);
        for (int k = 0; k < 20; ++k) {
            const auto side =
                static_cast<std::size_t>(draw.whole(0, static_cast<int>(corners.size()) - 1));
            const Vec2d a = corners[side];
            const Vec2d b = corners[(side + 1) % corners.size()];
            const Vec2d inward = Vec2d{a.y - b.y, b.x - a.x} * (1 / norm(b - a));
            const double in = draw.uniform(0, operation.prismatic->width);
            const Vec2d p = a + (b - a) * draw.uniform(0.3, 0.7) + inward * in;
            if (from_outline(p, corners) < in - 1e-9) {
                continue;  // another edge is nearer
            }
            double lowest = 0;
            for (const Place& place : places) {
                const double d = norm(in_plan(place.tip) - p);
                lowest = std::min(
                    lowest, place.tip.z + slope * std::max(0.0, d - operation.tool.tip_radius));
            }
            const double wanted = -(operation.prismatic->width - in) * slope;
            DOUBLES_EQUAL(wanted, lowest, 2e-3 * std::max(1.0, slope));
        }
    }
}

}  // namespace
}  // namespace cusp::test
