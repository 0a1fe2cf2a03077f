// Random floors, tools and feeds for jobs of all strategies.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/test_jobs.hpp"

namespace cusp::test {

inline int whole(Random& random, int low, int high)
{
    return std::uniform_int_distribution<int>{low, high}(random);
}

// A box whose low corner is up to (along_x, along_y) from zero, with sides of `least` to `most`.
inline offset::Box2d random_box(Random& random, Vec2d along, double least, double most)
{
    const double x = uniform(random, 0.0, along.x);
    const double y = uniform(random, 0.0, along.y);
    return {x, y, x + uniform(random, least, most), y + uniform(random, least, most)};
}

inline std::vector<double> even_knots(int points, int degree)
{
    std::vector<double> knots;
    for (int i = 0; i <= points + degree; ++i) {
        knots.push_back(std::clamp(static_cast<double>(i - degree) / (points - degree), 0.0, 1.0));
    }
    return knots;
}

// A B-spline graph on the box whose control points vary by `rough` mm around `middle`; sometimes
// rational.
inline nurbs::Surface random_floor(Random& random,
                                   const offset::Box2d& box,
                                   double middle,
                                   double rough)
{
    nurbs::Surface s;
    s.degree_u = s.degree_v = whole(random, 2, 3);
    s.size_u = whole(random, 4, 8);
    s.size_v = whole(random, 4, 8);
    s.knots_u = even_knots(s.size_u, s.degree_u);
    s.knots_v = even_knots(s.size_v, s.degree_v);
    const bool rational = whole(random, 0, 3) == 0;
    for (int i = 0; i < s.size_u; ++i) {
        for (int j = 0; j < s.size_v; ++j) {
            s.points.push_back({box.x0 + (box.x1 - box.x0) * i / (s.size_u - 1),
                                box.y0 + (box.y1 - box.y0) * j / (s.size_v - 1),
                                middle + uniform(random, -rough, rough)});
            s.weights.push_back(rational ? uniform(random, 0.6, 1.6) : 1.0);
        }
    }
    return s;
}

// Trims the surface to a smaller square with a hole. The domain is that of even_knots().
inline void trim(Random& random, nurbs::Surface& surface)
{
    const double low = uniform(random, 0.02, 0.2);
    const double high = uniform(random, 0.8, 0.98);
    const double hole = uniform(random, 0.05, 0.25);
    surface.trims = {
        loop_of({{low, low}, {high, low}, {high, high}, {low, high}}),
        loop_of({{0.5, 0.5 - hole}, {0.5 - hole, 0.5}, {0.5, 0.5 + hole}, {0.5 + hole, 0.5}})};
}

inline toolpath::Tool random_tool(Random& random)
{
    constexpr double kRadii[]{1.5, 2.0, 3.0, 4.0};
    const double radius = kRadii[whole(random, 0, 3)];
    switch (whole(random, 0, 5)) {
        case 0:
            return {1, toolpath::ToolShape::kFlat, radius, 0};
        case 1:
            return {1, toolpath::ToolShape::kBull, radius, radius * uniform(random, 0.2, 0.7)};
        default:
            return {1, toolpath::ToolShape::kBall, radius, radius};
    }
}

// A job of one operation, with feeds and a clearance for any test.
inline job::Job job_of(const job::Operation& operation)
{
    job::Job job = plain_job();
    job.spindle = 10000;
    job.tools =
        operation.tools.empty() ? std::vector<toolpath::Tool>{operation.tool} : operation.tools;
    job.operations = {operation};
    return job;
}

}  // namespace cusp::test
