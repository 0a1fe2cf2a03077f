// Layers of bounded engagement in random pockets, cut by a flat end on a raster of heights: the
// angle holds, no cut is deeper than max_depth, and no rapid move meets stock.
//
// Not judged: the angle of passes along walls and over cells, which have no bound; the first turn at
// an entry's foot; a thousandth of the way, and what the raster finds too much: kRasterDegrees. A layer's pass along the wall has
// chords of its own: what is left or cut between them is no depth of cut.
#include <cmath>
#include <cstdio>

#include "host_tools/cam/grid_pocket/adaptive_layers.hpp"
#include "host_tools/cam/grid_pocket/grid_passes.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/random_pockets.hpp"
#include "tests/judges/height_raster.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"

namespace cusp::test {

using namespace grid_pocket;
using namespace job;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kRasterPitch = 1.0 / 40;  // radii
constexpr double kRasterStep = 1.0 / 30;   // radii between places of the tool
constexpr double kRasterDegrees = 6.0;
constexpr double kFoot = 0.5;     // radii of way at an entry's foot
constexpr double kHigher = 1e-3;  // mm over the plane is stock

struct Judged {
    double way{};    // mm in stock, of the layers' passes
    double over{};   // mm of it over the angle
    double worst{};  // degrees
    double deepest{};
    double rapid{};  // mm deep in stock
};

class Judge {
public:
    Judge(const Job& job, const PocketSpace& pocket)
        : operation_{job.operations.front()},
          limit_{*operation_.passes.max_engagement + kRasterDegrees},
          raster_{box_about(pocket), job.stock_top, kRasterPitch * operation_.tool.radius}
    {
    }

    // Moves that the layer has added, from where the tool is.
    void cut(const std::vector<ToolMove>& moves, std::size_t first, const AdaptiveLayer& layer)
    {
        std::vector<Place> places;
        for (std::size_t k = first; k < moves.size(); ++k) {
            for (const Vec3d p : points_of(moves[k], at_, 1e-3)) {
                if (started_) {
                    add_straight(moves[k].kind, p, places);
                }
                at_ = p;
                started_ = true;
            }
        }
        const RegionOffset region{layer.region};
        for (std::size_t k = 1; k < places.size(); ++k) {
            const Place& next = places[k];
            const auto is_level = [&](const Place& place) {
                return std::abs(place.tip.z - layer.z) < 1e-6;
            };
            const double way = norm(next.tip - places[k - 1].tip);
            since_entry_ = next.kind == MoveKind::kPlunge ? 0.0 : since_entry_ + way;
            if (since_entry_ > kFoot * operation_.tool.radius && next.kind == MoveKind::kCut &&
                is_level(places[k - 1]) && is_level(next) && !layer.region.contours.empty() &&
                region.clearance(in_plan(next.tip)) > 0.0) {
                judge(places, k, layer.z + kHigher);
            }
            const double deep =
                raster_.cut(next.tip, operation_.tool.radius, operation_.tolerance.plan);
            double& deepest = next.kind == MoveKind::kRapid ? found.rapid : found.deepest;
            deepest = std::max(deepest, deep);
        }
    }

    Judged found{};

private:
    static Box2d box_about(const PocketSpace& pocket)
    {
        const double out = pocket.operation.tool.radius + 1.0;
        const Box2d box = box_of(pocket.centres);
        return {box.x0 - out, box.y0 - out, box.x1 + out, box.y1 + out};
    }

    struct Place {
        Vec3d tip;
        MoveKind kind;  // of the way to it
    };

    void add_straight(MoveKind kind, Vec3d end, std::vector<Place>& places) const
    {
        const double step = kRasterStep * operation_.tool.radius;
        const int n = 1 + static_cast<int>(norm(end - at_) / step);
        for (int i = 1; i <= n; ++i) {
            places.push_back({at_ + (end - at_) * (static_cast<double>(i) / n), kind});
        }
    }

    static Vec2d heading_to(const std::vector<Place>& places, std::size_t k)
    {
        const Vec2d way = in_plan(places[k].tip - places[k - 1].tip);
        return way * (1.0 / std::max(norm(way), 1e-12));
    }

    void judge(const std::vector<Place>& places, std::size_t k, double z)
    {
        const double way = norm(places[k].tip - places[k - 1].tip);
        if (way < 1e-9) {
            return;
        }
        std::size_t ahead = k;
        for (double left = raster_.ahead() - way;
             left > 0.0 && ahead + 1 < places.size() && places[ahead + 1].kind == MoveKind::kCut;) {
            ++ahead;
            left -= norm(places[ahead].tip - places[ahead - 1].tip);
        }
        const double angle = raster_.engagement(
            operation_.tool.radius, {in_plan(places[k - 1].tip), heading_to(places, k)},
            {in_plan(places[ahead].tip), heading_to(places, ahead)}, z);
        found.way += angle > 0.0 ? way : 0.0;
        found.over += angle > limit_ ? way : 0.0;
        found.worst = std::max(found.worst, angle);
    }

    const Operation& operation_;
    double limit_;
    HeightRaster raster_;
    Vec3d at_{};
    bool started_{false};
    double since_entry_{};  // mm of way
};

void check_layers(const Job& job)
{
    const Operation& operation = job.operations.front();
    PocketSpace pocket{job, operation, pocket_walls(job, operation)};
    if (pocket.centres.contours.empty()) {
        return;
    }
    pocket.heights = heights_over(pocket, pocket.finish);
    pocket.rough_heights = heights_over(pocket, pocket.rough);
    const AdaptiveLayers layers = adaptive_layers(pocket);
    Toolpath path;
    set_tool(path, job, operation.tool);
    GridPasses passes{pocket, path};
    Judge judge{job, pocket};
    double listed = 0.0;
    for (const AdaptiveLayer& layer : layers.layers) {
        const std::size_t first = path.moves.size();
        passes.adaptive_layer(layers, layer);
        judge.cut(path.moves, first, layer);
        CHECK(layer.path.engagement_bound <=
              *operation.passes.max_engagement / 57.29577951308232 + 1e-9);
        for (const auto& over : layer.path.over) {
            listed += over.length;
        }
    }
    const Judged& found = judge.found;
    std::printf(
        "  %d layers, %.0f mm in stock, %.2f mm over %.1f degrees, %.2f listed, %.1f mm deep\n",
        static_cast<int>(layers.layers.size()), found.way, found.over,
        *operation.passes.max_engagement, listed, found.deepest);
    CHECK(found.over <= listed + 1e-3 * found.way);
    CHECK(found.deepest <= *operation.levels.max_depth + 0.01);
    CHECK(found.rapid <= 0.01);
}

void check_seed(unsigned seed)
{
    std::printf("layers of bounded engagement seed %u\n", seed);
    Random random{seed};
    Job job = random_adaptive_pocket(random);
    Tool& tool = job.operations.front().tool;
    tool = {1, ToolShape::kFlat, tool.radius, 0};
    check_layers(job);
}

}  // namespace

TEST_GROUP(AdaptiveLayersProperty){};

TEST(AdaptiveLayersProperty, KeepAngleAndDepthOnARaster)
{
    for (int i = 0; i < property_cases(3); ++i) {
        check_seed(property_seed(2001) + static_cast<unsigned>(i));
    }
}

// A run along the wall began with a rapid move into the allowance; a link came down at rapid on a
// sliver that it had met while it rose.
TEST(AdaptiveLayersProperty, SeedsThatOnceFailed)
{
    check_seed(3057);
    check_seed(120203);
}

}  // namespace cusp::test
