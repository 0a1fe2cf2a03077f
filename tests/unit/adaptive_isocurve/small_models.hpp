// Surfaces of a few millimetres that are difficult in some way, and jobs over them.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "tests/support/test_jobs.hpp"

namespace cusp::test {

inline nurbs::Surface bumps(std::mt19937& random, double height)
{
    std::uniform_real_distribution<double> z{0, height};
    nurbs::Surface s;
    s.degree_u = s.degree_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 2, 2, 2, 2};
    s.size_u = s.size_v = 5;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            s.points.push_back({5.0 * i, 5.0 * j, z(random)});
        }
    }
    s.weights.assign(25, 1.0);
    return s;
}

inline nurbs::Surface wall(double x, double z)
{
    nurbs::Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.size_u = s.size_v = 2;
    s.points = {{x, 0, -2}, {x + 1, 0, z}, {x, 20, -2}, {x + 1, 20, z}};
    s.weights = {1, 1, 1, 1};
    return s;
}

// A floor that bends up into a wall, vertical at its open rim: x from 0 to 5, z from -5 to 0.
inline nurbs::Surface upright_rim()
{
    nurbs::Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 1};
    s.size_u = 2;
    s.size_v = 3;
    s.points = {{0, 0, -5}, {5, 0, -5}, {5, 0, 0}, {0, 6, -5}, {5, 6, -5}, {5, 6, 0}};
    s.weights.assign(6, 1.0);
    return s;
}

// Horizontal, with a trough along x that is too narrow for a ball of radius 2: the ball gets lower
// only beyond its ends.
inline nurbs::Surface trough()
{
    nurbs::Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
    s.size_u = 2;
    s.size_v = 5;
    for (const double x : {0.0, 2.0}) {
        for (const Vec2d p :
             {Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{1.5, -1.5}, Vec2d{2, 0}, Vec2d{3, 0}}) {
            s.points.push_back({x, p.x, p.y});
        }
    }
    s.weights.assign(10, 1.0);
    return s;
}

// Half a ball of radius 5, open upwards, as CAD writes it: all around u, its pole below.
inline nurbs::Surface bowl()
{
    constexpr double kRadius = 5;
    const double half = std::sqrt(0.5);
    const double turn[][3] = {{1, 0, 1},     {1, 1, half},  {0, 1, 1},
                              {-1, 1, half}, {-1, 0, 1},    {-1, -1, half},
                              {0, -1, 1},    {1, -1, half}, {1, 0, 1}};
    const double rise[][3] = {{0, -1, 1}, {1, -1, half}, {1, 0, 1}};
    nurbs::Surface s;
    s.degree_u = s.degree_v = 2;
    s.knots_u = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.knots_v = {0, 0, 0, 1, 1, 1};
    s.size_u = 9;
    s.size_v = 3;
    for (const auto& a : turn) {
        for (const auto& b : rise) {
            s.points.push_back(
                {7.3 + kRadius * b[0] * a[0], -4.1 + kRadius * b[0] * a[1], kRadius * b[1] - 0.37});
            s.weights.push_back(a[2] * b[2]);
        }
    }
    return s;
}

// Open at y = 0, and 4 mm wide: a ball of radius 3 reaches into it from beyond that side.
inline nurbs::Surface half_bowl()
{
    const double half = std::sqrt(0.5);
    nurbs::Surface s;
    s.degree_u = 3;
    s.degree_v = 2;
    s.knots_u = {0, 0, 0, 0, 1, 1, 1, 1};
    s.knots_v = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
    s.size_u = 4;
    s.size_v = 5;
    for (const Vec2d p : {Vec2d{0, -6.94}, Vec2d{0.8, -6.94}, Vec2d{2, -4.56}, Vec2d{2, -1}}) {
        const std::array<Vec2d, 5> ring{Vec2d{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}};
        for (std::size_t k = 0; k < ring.size(); ++k) {
            s.points.push_back({p.x * ring[k].x, p.x * ring[k].y, p.y});
            s.weights.push_back(k % 2 == 1 ? half : 1);
        }
    }
    return s;
}

inline nurbs::Surface plane(Vec3d low, Vec3d high_y, Vec3d high_x, Vec3d high)
{
    nurbs::Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.size_u = s.size_v = 2;
    s.points = {low, high_y, high_x, high};
    s.weights.assign(4, 1.0);
    return s;
}

// A roof with a gap of 0.6 mm along its ridge at x = 5, z = -2.5: a floor is visible through it.
inline std::vector<nurbs::Surface> open_roof()
{
    return {plane({0, 0, -4.7}, {0, 4, -4.7}, {4.7, 0, -2.5}, {4.7, 4, -2.5}),
            plane({5.3, 0, -2.5}, {5.3, 4, -2.5}, {10, 0, -4.7}, {10, 4, -4.7}),
            plane({1.4, 0.5, -6}, {1.4, 3.5, -6}, {9.4, 0.5, -6}, {9.4, 3.5, -6})};
}

inline job::Job job_for(std::vector<nurbs::Surface> floor, const job::Strategy& strategy)
{
    job::Job job = plain_job();
    job.tools = {{1, toolpath::ToolShape::kBall, 2, 2}};
    job.stock_top = 20;
    job::Operation operation;
    operation.strategy = &strategy;
    operation.part.floor = std::move(floor);
    operation.tool = job.tools.front();
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = 0.2;
    job.operations = {operation};
    return job;
}

}  // namespace cusp::test
