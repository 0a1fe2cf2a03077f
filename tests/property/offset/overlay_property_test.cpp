// Overlays of random and degenerate pairs of regions, judged by Clipper's areas, by membership of
// random points and by what a region must be.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <polyclipping/clipper.hpp>

#include "host_tools/geometry/offset/edge_crossings.hpp"
#include "host_tools/geometry/offset/edge_runs.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "tests/generators/region_pairs.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace offset;

namespace {

constexpr double kUnit = 1e8;        // of Clipper's grid, per mm
constexpr double kSagitta = 1e-5;    // mm: of the judge's chords
constexpr double kDeviation = 4e-6;  // mm: of the border, as promised

ClipperLib::Paths chords_of(const Region2d& region)
{
    ClipperLib::Paths paths;
    for (const Contour& contour : region.contours) {
        ClipperLib::Path path;
        for (const Edge& edge : contour) {
            const double each = std::sqrt(8.0 * kSagitta / std::max(edge.radius, kSagitta));
            const int n = 1 + static_cast<int>(sweep(edge) / each);
            for (int i = 0; i < n; ++i) {
                const Vec2d p = point_on(edge, static_cast<double>(i) / n);
                path.emplace_back(std::llround(p.x * kUnit), std::llround(p.y * kUnit));
            }
        }
        paths.push_back(path);
    }
    return paths;
}

double clipper_area(const Region2d& a, const Region2d& b, ClipperLib::ClipType type)
{
    ClipperLib::Clipper clipper;
    clipper.AddPaths(chords_of(a), ClipperLib::ptSubject, true);
    clipper.AddPaths(chords_of(b), ClipperLib::ptClip, true);
    ClipperLib::Paths out;
    clipper.Execute(type, out, ClipperLib::pftPositive, ClipperLib::pftPositive);
    double sum = 0.0;
    for (const ClipperLib::Path& path : out) {
        sum += ClipperLib::Area(path);
    }
    return sum / (kUnit * kUnit);
}

int winding(const Region2d& region, Vec2d p)
{
    int sum = 0;
    for (const Contour& contour : region.contours) {
        sum += surrounds(contour, p) ? (area(contour) > 0.0 ? 1 : -1) : 0;
    }
    return sum;
}

double border(const Region2d& region)
{
    double sum = 0.0;
    for (const Contour& contour : region.contours) {
        sum += length(contour);
    }
    return sum;
}

// True if `a` comes away from `b` by more than the deviation on both sides of their crossing `p`,
// before its end or their next crossing.
bool comes_away(const Edge& a, const Edge& b, const Crossings& found, Vec2d p)
{
    Vec2d before = a.start;
    Vec2d after = a.end;
    const double along = share_of_chord(a, p);
    for (const Vec2d q : found) {
        const double share = share_of_chord(a, q);
        before = share < along && share > share_of_chord(a, before) ? q : before;
        after = share > along && share < share_of_chord(a, after) ? q : after;
    }
    return distance_to(b, nearest_on(a, (before + p) * 0.5)) > kDeviation &&
           distance_to(b, nearest_on(a, (p + after) * 0.5)) > kDeviation;
}

bool pass_through(const Edge& a, const Edge& b)
{
    const Crossings found = crossings(a, b, 0.0);
    return std::any_of(found.begin(), found.end(), [&](Vec2d p) {
        return comes_away(a, b, found, p) && comes_away(b, a, found, p);
    });
}

const char* wrong_form(const Region2d& region)
{
    std::vector<Edge> edges = edges_of(region);
    for (const Contour& contour : region.contours) {
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const Vec2d end = contour[i].end;
            const Vec2d next = contour[(i + 1) % contour.size()].start;
            if (end.x != next.x || end.y != next.y) {
                return "a loop is open";
            }
            if (distance(contour[i].start, end) < kSamePoint) {
                return "an edge has no length";
            }
        }
    }
    const EdgeTree tree{edges};
    bool crossed = false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        tree.visit_meeting(box_of(edges[i]), [&](std::uint32_t j) {
            crossed = crossed || (j > i && pass_through(edges[i], edges[j]));
        });
    }
    return crossed ? "edges cross" : nullptr;
}

struct Rule {
    const char* name;
    Region2d (*overlay)(const Region2d&, const Region2d&);
    bool (*keeps)(bool, bool);
    ClipperLib::ClipType type;
};

constexpr Rule kRules[] = {
    {"common", common, [](bool a, bool b) { return a && b; }, ClipperLib::ctIntersection},
    {"united", united, [](bool a, bool b) { return a || b; }, ClipperLib::ctUnion},
    {"without", without, [](bool a, bool b) { return a && !b; }, ClipperLib::ctDifference},
};

std::string wrong_of(unsigned seed, PairSize size)
{
    const RegionPair pair = random_pair(seed, size);
    Random random{seed};
    const double around = border(pair.a) + border(pair.b) + 1.0;
    std::vector<Vec2d> points;
    const Box2d box = box_of(pair.a);
    for (int i = 0; i < 20; ++i) {
        const Vec2d p{uniform(random, box.x0 - 1, box.x1 + 1),
                      uniform(random, box.y0 - 1, box.y1 + 1)};
        if (distance_to(pair.a, p) > 1e-5 && distance_to(pair.b, p) > 1e-5) {
            points.push_back(p);
        }
    }
    for (const Rule& rule : kRules) {
        const std::string place =
            "seed " + std::to_string(seed) + ": " + pair.kind + ", " + rule.name + ": ";
        const Region2d out = rule.overlay(pair.a, pair.b);
        if (const char* const fault = wrong_form(out)) {
            return place + fault;
        }
        for (const Vec2d p : points) {
            const bool in = rule.keeps(winding(pair.a, p) > 0, winding(pair.b, p) > 0);
            if (winding(out, p) != (in ? 1 : 0)) {
                return place + "a point is on the wrong side";
            }
        }
        const double judged = clipper_area(pair.a, pair.b, rule.type);
        if (std::abs(area(out) - judged) > (kDeviation + kSagitta) * around) {
            return place + "area " + std::to_string(area(out)) + " mm2, not " +
                   std::to_string(judged);
        }
    }
    return {};
}

TEST_GROUP(RandomOverlay){};

TEST(RandomOverlay, IsARegionOfTheRightPoints)
{
    const auto wrong = [](unsigned seed) {
        return wrong_of(seed, {});
    };
    STRCMP_EQUAL("", broken_cases(property_seed(1), property_cases(2000), wrong).c_str());
}

// A million of them, outside CI: CUSP_PROPERTY_CASES, with -n OfSmallPairs.
TEST(RandomOverlay, OfSmallPairsIsARegionOfTheRightPoints)
{
    const auto wrong = [](unsigned seed) {
        return wrong_of(seed, kSmallPairs);
    };
    STRCMP_EQUAL("", broken_cases(property_seed(1), property_cases(2000), wrong).c_str());
}

}  // namespace

}  // namespace cusp::test
