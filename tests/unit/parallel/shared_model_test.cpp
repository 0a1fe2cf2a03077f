// Threads that share a model find the same bits as one thread.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::toolpath;

namespace {

constexpr unsigned kSeed = 20261123;
constexpr int kNodes = 7;
constexpr double kSide = 12;  // mm

// Bicubic hills with random heights.
Surface hills(std::mt19937& random, double from_x)
{
    std::uniform_real_distribution<double> height{-3, 0};
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = kNodes;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4};
    for (int i = 0; i < kNodes; ++i) {
        for (int j = 0; j < kNodes; ++j) {
            s.points.push_back(
                {from_x + kSide * i / (kNodes - 1), kSide * j / (kNodes - 1), height(random)});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

std::vector<std::array<Vec3d, 3>> triangles_of(const Surface& surface)
{
    constexpr int kParts = 14;
    const auto at = [&](int i, int j) {
        return point_at(surface, 4.0 * i / kParts, 4.0 * j / kParts);
    };
    std::vector<std::array<Vec3d, 3>> out;
    for (int i = 0; i < kParts; ++i) {
        for (int j = 0; j < kParts; ++j) {
            out.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            out.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return out;
}

// Answers of many queries of every kind, in parts.
std::vector<double> answers(const PartModel& model, int threads)
{
    constexpr std::size_t kParts = 24;
    constexpr std::size_t kQueries = 6;
    parallel::set_threads(threads);
    model.forget_cells();
    std::vector<double> out(kParts * kQueries * 3);
    parallel::for_each(kParts, [&](std::size_t part) {
        model.forget_queries();
        std::mt19937 random{kSeed + static_cast<unsigned>(part)};
        std::uniform_real_distribution<double> place{0, kSide};
        const Tool ball{1, ToolShape::kBall, 2, 2};
        const Tool flat{2, ToolShape::kFlat, 2.5, 0};
        for (std::size_t k = 0; k < kQueries; ++k) {
            const double x = place(random);
            const double y = place(random);
            double* to = &out[3 * (part * kQueries + k)];
            to[0] = model.drop_height(ball, x, y).value_or(1);
            to[1] = model.move_clearance(flat, {x, y, 1}, {y, x, 0.5}, 2, 1e-4);
            if (model.is_mesh()) {
                to[2] = model.drop_ball(x, y, 2)->point.z;
                continue;
            }
            const CcPoint from = model.cc_point(0, x / 3.1, y / 3.1, 2.1);
            const CcPoint to_point = model.cc_point(0, x / 3.1 + 0.01, y / 3.1, 2.1);
            to[2] = model.move_clearance_between_contacts(from, to_point, 2, 0.05).value_or(-1);
        }
    });
    return out;
}

}  // namespace

TEST_GROUP(SharedModel){void setup() override{std::printf("seed %u\n", kSeed);
}
}
;

TEST(SharedModel, OfSurfacesAnswersEveryThreadAlike)
{
    std::mt19937 random{kSeed};
    const PartModel model{{hills(random, 0), hills(random, kSide)}};
    const std::vector<double> one = answers(model, 1);
    for (const int threads : {3}) {
        CHECK(answers(model, threads) == one);
    }
}

TEST(SharedModel, OfTrianglesAnswersEveryThreadAlike)
{
    std::mt19937 random{kSeed};
    const PartModel model{triangles_of(hills(random, 0))};
    const std::vector<double> one = answers(model, 1);
    for (const int threads : {3}) {
        CHECK(answers(model, threads) == one);
    }
}

// Passes of more than 128 lines: each is several parts of the loop.
TEST(SharedModel, FitsLongPassesAlikeOnEveryThread)
{
    std::mt19937 random{kSeed};
    const PartModel model{{hills(random, 0)}};
    const GougeFreePathFitter whole{
        model, {1, ToolShape::kBall, 1.5, 1.5}, make_tolerance_band(0.002, true)};
    std::vector<std::vector<Points>> found;
    for (const int threads : {1, 3}) {
        parallel::set_threads(threads);
        model.forget_cells();
        std::vector<Points>& passes = found.emplace_back(6);
        const PartModel::SharedQueries shared{model};
        parallel::for_each(passes.size(), [&](std::size_t k) {
            const PartModel::SharedQueries::Part queries{model};
            GougeFreePathFitter fitter = whole;
            fitter.set_part(queries);
            Points dense;
            for (int row = 0; row < 8; ++row) {
                const double y = 0.5 + 1.8 * static_cast<double>(k) + 0.3 * row;
                const Points there = fitter.sample_dropped({0.5, y, 0}, {kSide - 0.5, y, 0});
                dense.insert(dense.end(), there.begin(), there.end());
            }
            passes[k] = fitter.fit_lines(dense);
        });
    }
    for (std::size_t k = 0; k < found.front().size(); ++k) {
        CHECK(found.front()[k].size() > 128);
        CHECK(found.front()[k] == found.back()[k]);
    }
}

// Passes too far apart: what is missing is found by copies of the check.
TEST(SharedModel, IsCheckedForScallopsAlikeByAnyNumberOfThreads)
{
    const Tool ball{1, ToolShape::kBall, 3, 3};
    constexpr double kScallop = 0.2;
    const auto passes_of = [&](auto& check, GougeFreePathFitter& fitter, auto check_all,
                               auto add_missing) {
        std::vector<Points> passes;
        for (double y = 0; y <= kSide; y += 4) {
            check.add(fitter.sample_dropped({0, y, 0}, {kSide, y, 0}));
        }
        check_all();
        add_missing([&](const Points& tips) {
            passes.push_back(tips);
            check.add(tips);
        });
        return passes;
    };
    std::vector<std::vector<Points>> found;
    for (const int threads : {1, 4}) {
        parallel::set_threads(threads);
        std::mt19937 random{kSeed};
        const std::vector<Surface> surfaces{hills(random, 0)};
        const PartModel model{surfaces};
        GougeFreePathFitter fitter{model, ball, make_tolerance_band(0.02, true)};
        ScallopCheck check{surfaces, fitter, kScallop, 0};
        found.push_back(passes_of(
            check, fitter, [&] { check.check_all([](double) {}); },
            [&](const auto& cut) { check.add_missing_passes(cut, [](double) {}); }));
        const auto triangles = triangles_of(surfaces.front());
        const PartModel mesh{triangles};
        GougeFreePathFitter mesh_fitter{mesh, ball, make_tolerance_band(0.02, true)};
        MeshScallopCheck mesh_check{triangles, mesh_fitter, kScallop, 0};
        found.push_back(passes_of(
            mesh_check, mesh_fitter, [&] { mesh_check.check(); },
            [&](const auto& cut) { mesh_check.add_missing_passes(cut); }));
    }
    CHECK(!found[0].empty());
    CHECK(!found[1].empty());
    CHECK(found[0] == found[2]);
    CHECK(found[1] == found[3]);
}
