// Random height fields intersected: at random points the result is the lowest of them, and only
// that.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "host_tools/geometry/part_model/model_intersection.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace nurbs;
using namespace part_model;

namespace {

constexpr int kLooks = 4000;
// mm of height between two fields: nearer to each other the outline may pass on either side.
constexpr double kAlike = 1e-3;
constexpr double kEdge = 1e-3;  // mm from a field's edge: the same

struct Field {
    Vec2d low;
    double size;
    Surface surface;

    bool covers(Vec2d p, double margin) const
    {
        return p.x > low.x - margin && p.x < low.x + size + margin && p.y > low.y - margin &&
               p.y < low.y + size + margin;
    }
    Vec2d parameters(Vec2d p) const { return (1 / size) * (p - low); }
    double height(Vec2d p) const
    {
        const Vec2d uv = parameters(p);
        return point_at(surface, uv.x, uv.y).z;
    }
};

// Control points are at the Greville abscissae: x and y are linear in u and v.
Field random_field(std::mt19937& random)
{
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    Field field{{within(-2, 2), within(-2, 2)}, within(4, 12), {}};
    Surface& s = field.surface;
    s.degree_u = s.degree_v = static_cast<int>(within(1, 3.99));
    s.size_u = s.size_v = s.degree_u + 1 + static_cast<int>(within(0, 4.99));
    const int spans = s.size_u - s.degree_u;
    for (int k = -s.degree_u; k <= s.size_u; ++k) {
        s.knots_u.push_back(static_cast<double>(std::clamp(k, 0, spans)) / spans);
    }
    s.knots_v = s.knots_u;
    const auto greville = [&](int i) {
        double sum = 0;
        for (int k = 1; k <= s.degree_u; ++k) {
            sum += s.knots_u[static_cast<std::size_t>(i + k)];
        }
        return sum / s.degree_u;
    };
    const double base = within(-0.7, 0.7);
    for (int i = 0; i < s.size_u; ++i) {
        for (int j = 0; j < s.size_v; ++j) {
            s.points.push_back({field.low.x + field.size * greville(i),
                                field.low.y + field.size * greville(j), base + within(-1, 1)});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return field;
}

struct Left {
    const Field* field;
    TrimRegion region;
};

std::vector<Left> left_of(const std::vector<Field>& fields)
{
    std::vector<std::vector<Surface>> models;
    for (const Field& field : fields) {
        models.push_back({field.surface});
    }
    std::vector<Left> out;
    for (const Surface& s : intersection_of(models)) {
        const auto field = std::find_if(fields.begin(), fields.end(), [&](const Field& f) {
            return f.surface.points[0].x == s.points[0].x && f.surface.points[0].z == s.points[0].z;
        });
        out.push_back({&*field, TrimRegion{s, 1e-4}});
    }
    return out;
}

// The highest of the surfaces there, each over its field; -infinity where none is left.
double height_left(const std::vector<Left>& left, Vec2d p)
{
    double highest = -kInfinite;
    for (const auto& [field, region] : left) {
        const Vec2d uv = field->parameters(p);
        const bool over = field->covers(p, 0) && (!region.trimmed() || region.inside(uv.x, uv.y));
        if (over) {
            highest = std::max(highest, field->height(p));
        }
    }
    return highest;
}

}  // namespace

TEST_GROUP(IntersectionProperty){};

TEST(IntersectionProperty, WhatIsLeftIsTheLowest)
{
    const int cases = property_cases(6);
    int judged = 0;
    for (int seed = 1; seed <= cases; ++seed) {
        std::mt19937 random{static_cast<unsigned>(seed)};
        std::vector<Field> fields;
        for (int k = 0; k < 2 + seed % 2; ++k) {
            fields.push_back(random_field(random));
        }
        const std::vector<Left> left = left_of(fields);
        std::uniform_real_distribution<double> place{-2.0, 14.0};
        for (int k = 0; k < kLooks; ++k) {
            const Vec2d p{place(random), place(random)};
            std::vector<double> heights;
            bool everywhere = true;
            bool doubtful = false;
            for (const Field& field : fields) {
                everywhere = everywhere && field.covers(p, 0);
                doubtful = doubtful || field.covers(p, kEdge) != field.covers(p, -kEdge);
                heights.push_back(field.covers(p, 0) ? field.height(p) : -kInfinite);
            }
            std::sort(heights.begin(), heights.end());
            if (doubtful || (everywhere && heights[1] - heights[0] < kAlike)) {
                continue;
            }
            ++judged;
            const double found = height_left(left, p);
            const double due = everywhere ? heights[0] : -kInfinite;
            if (found != due) {
                std::printf("seed %d at %.6f %.6f: %.6f left, %.6f due, next %.6f\n", seed, p.x,
                            p.y, found, due, heights[1]);
            }
            CHECK(found == due);
        }
    }
    CHECK(judged > cases * kLooks / 2);
}

}  // namespace cusp::test
