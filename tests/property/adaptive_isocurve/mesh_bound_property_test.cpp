// Random polyhedra, finished and judged by brute force: within the ball's reach no more is left than
// the plan claims, and no move cuts deeper than it claims.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "host_tools/adaptive_isocurve/adaptive_isocurve.hpp"
#include "tests/property/adaptive_isocurve/ball_on_triangles.hpp"
#include "tests/property/adaptive_isocurve/random_polyhedra.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_isocurve;
using namespace job;
using namespace toolpath;

namespace {

constexpr int kPlaces = 1500;       // of a part that are judged
constexpr double kExact = 1e-3;     // mm: chords of arcs, and searches
constexpr double kFinest = 1e-4;    // mm: of positions
constexpr double kPositions = 0.1;  // radii: pitch of the first ones
constexpr double kGougeStep = 0.2;  // mm

Job random_job(Random& random)
{
    Job job = plain_job();
    const double radius = uniform(random, 0.5, 3.0);
    job.tools = {{1, ToolShape::kBall, radius, radius}};
    Operation operation;
    operation.strategy = "adaptive_isocurve";
    operation.mesh = random_polyhedron(random);
    operation.tool = job.tools.front();
    operation.scallop = radius * std::pow(10.0, uniform(random, -1.9, -1.0));
    operation.floor_tolerance = operation.plan_tolerance =
        *operation.scallop * uniform(random, 0.1, 0.4);
    operation.direction = whole(random, 0, 1) == 0 ? 'u' : 'v';
    constexpr OutputForm kForms[] = {OutputForm::kLines, OutputForm::kLines, OutputForm::kArcs,
                                     OutputForm::kNurbs};
    operation.output = kForms[whole(random, 0, 3)];
    job.stock_top = -kNothing;
    for (const auto& t : operation.mesh) {
        job.stock_top = std::max({job.stock_top, t[0].z, t[1].z, t[2].z});
    }
    job.stock_top += uniform(random, 0.0, 2.0);
    job.operations = {operation};
    return job;
}

struct Worst {
    double left{};  // mm, over what is claimed
    Vec3d place;
    Vec3d normal;
};

class Judge {
public:
    Judge(const Operation& operation, const CutMoves& moves)
        : mesh_{operation.mesh},
          part_{mesh_},
          moves_{moves},
          radius_{operation.tool.radius},
          clear_of_{operation.floor_tolerance}
    {
        Vec3d high{-kNothing, -kNothing, 0};
        low_ = -high;
        for (const auto& t : mesh_) {
            for (const Vec3d& p : t) {
                low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), 0};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
            }
            areas_.push_back((areas_.empty() ? 0 : areas_.back()) +
                             norm(cross(t[1] - t[0], t[2] - t[0])));
        }
        low_ = low_ - Vec3d{radius_, radius_, 0};
        pitch_ = kPositions * radius_;
        nx_ = 2 + static_cast<int>((high.x + radius_ - low_.x) / pitch_);
        ny_ = 2 + static_cast<int>((high.y + radius_ - low_.y) / pitch_);
        for (int i = 0; i < nx_; ++i) {
            for (int j = 0; j < ny_; ++j) {
                centres_.push_back(drop(low_.x + i * pitch_, low_.y + j * pitch_));
            }
        }
    }

    // The one of `places` where most is left over the bound.
    Worst most_left(Random& random, double bound) const
    {
        Worst worst;
        for (int k = 0; k < kPlaces; ++k) {
            const std::size_t facet = k % 2 == 0 ? by_area(random) : by_chance(random);
            const Vec3d place = place_on(random, mesh_[facet]);
            const Vec3d normal = BallOnTriangles::normal(mesh_[facet]);
            if (!(normal.z > 1e-6) || part_.top(place.x, place.y) > place.z + 1e-6) {
                continue;
            }
            const double over = left_over(place, normal, bound) - bound;
            if (over > worst.left) {
                worst = {over, place, normal};
            }
        }
        return worst;
    }

    // mm: how deep the moves cut.
    double deepest() const
    {
        double deepest = 0;
        for (const auto& [a, b] : moves_.moves()) {
            const int parts = 1 + static_cast<int>(norm(b - a) / kGougeStep);
            for (int k = 0; k <= parts; ++k) {
                const Vec3d at = a + (b - a) * (static_cast<double>(k) / parts);
                const double allowed = part_.drop(at.x, at.y, radius_);
                // On a steep wall the depth is far less than the way straight up.
                if (at.z < allowed - deepest) {
                    deepest = std::max(deepest, depth_of(at));
                }
            }
        }
        return deepest;
    }

private:
    double drop(double x, double y) const { return part_.drop(x, y, radius_ + clear_of_); }

    // The radius less that of the largest ball at the place that cuts nothing.
    double depth_of(Vec3d centre) const
    {
        double low = 0;
        double high = radius_;
        while (high - low > kFinest) {
            const double middle = 0.5 * (low + high);
            (part_.drop(centre.x, centre.y, radius_ - middle) > centre.z ? low : high) = middle;
        }
        return low;
    }

    std::size_t by_area(Random& random) const
    {
        const auto at =
            std::lower_bound(areas_.begin(), areas_.end(), uniform(random, 0.0, areas_.back()));
        return std::min(mesh_.size() - 1, static_cast<std::size_t>(at - areas_.begin()));
    }
    std::size_t by_chance(Random& random) const
    {
        return static_cast<std::size_t>(whole(random, 0, static_cast<int>(mesh_.size()) - 1));
    }
    static Vec3d place_on(Random& random, const std::array<Vec3d, 3>& t)
    {
        const double a = std::sqrt(uniform(random, 0.0, 1.0));
        const double b = uniform(random, 0.0, 1.0);
        return t[0] * (1 - a) + t[1] * (a * (1 - b)) + t[2] * (a * b);
    }

    // Thickness of the stock left at a place, along the normal, above what a ball can reach there.
    // Stock that is high but thin, as beside a wall, counts by its thickness.
    double left_over(Vec3d place, Vec3d normal, double bound) const
    {
        const double top = moves_.top(place.x, place.y);
        const auto left = [&](Vec3d from) {
            return std::min((top - from.z) * normal.z, moves_.depth(from));
        };
        if (left(place) <= bound) {
            return 0;
        }
        const double touching = radius_ + clear_of_;
        const Vec3d centre = place + normal * touching;
        if (drop(centre.x, centre.y) <= centre.z + 1e-9) {
            return left(place);
        }
        const double reach = lowest_over(place);
        return left({place.x, place.y, std::max(place.z, reach)});
    }

    double height_under(Vec3d centre, Vec3d place) const
    {
        const double x = centre.x - place.x;
        const double y = centre.y - place.y;
        const double square = radius_ * radius_ - x * x - y * y;
        return square < 0 ? kNothing : centre.z - std::sqrt(square);
    }
    double height_at(double x, double y, Vec3d place) const
    {
        return height_under({x, y, drop(x, y)}, place);
    }

    // The lowest cut of a ball over the place, searched from the best positions on the grid.
    double lowest_over(Vec3d place) const
    {
        struct Start {
            double height, x, y;
        };
        std::vector<Start> starts;
        const int reach = static_cast<int>(radius_ / pitch_) + 1;
        const int i0 = static_cast<int>((place.x - low_.x) / pitch_);
        const int j0 = static_cast<int>((place.y - low_.y) / pitch_);
        for (int i = std::max(0, i0 - reach); i <= std::min(nx_ - 1, i0 + reach); ++i) {
            for (int j = std::max(0, j0 - reach); j <= std::min(ny_ - 1, j0 + reach); ++j) {
                const Vec3d centre{low_.x + i * pitch_, low_.y + j * pitch_,
                                   centres_[static_cast<std::size_t>(i * ny_ + j)]};
                const double height = height_under(centre, place);
                if (std::isfinite(height)) {
                    starts.push_back({height, centre.x, centre.y});
                }
            }
        }
        std::sort(starts.begin(), starts.end(),
                  [](const Start& a, const Start& b) { return a.height < b.height; });
        double best = kNothing;
        for (std::size_t k = 0; k < std::min<std::size_t>(3, starts.size()); ++k) {
            Start at = starts[k];
            for (double step = pitch_; step > kFinest;) {
                bool better = false;
                for (int way = 0; way < 8; ++way) {
                    const double turn = kPi / 4 * way;
                    const double x = at.x + step * std::cos(turn);
                    const double y = at.y + step * std::sin(turn);
                    const double height = height_at(x, y, place);
                    if (std::isfinite(height) && height < at.height - 1e-9) {
                        at = {height, x, y};
                        better = true;
                        break;
                    }
                }
                step *= better ? 1 : 0.5;
            }
            best = std::min(best, at.height);
        }
        return best;
    }

    const Triangles& mesh_;
    BallOnTriangles part_;
    const CutMoves& moves_;
    double radius_;
    double clear_of_;            // mm: clearance of the ball by a one-sided tolerance
    std::vector<double> areas_;  // of the facets up to each
    std::vector<double> centres_;
    Vec3d low_;
    double pitch_{};
    int nx_{};
    int ny_{};
};

bool holds(unsigned seed)
{
    Random random{seed};
    const Job job = random_job(random);
    const Operation& operation = job.operations.front();
    const PlannedOperation planned = plan_adaptive_isocurve(job, operation).front();
    const CutMoves moves{planned.path, 0.01 * operation.floor_tolerance};
    const Judge judge{operation, moves};
    const double bound = planned.stats.scallop_bound_mm;
    const Worst worst = judge.most_left(random, bound + kExact);
    const double gouge = judge.deepest();
    const bool good = !(worst.left > 0) && gouge <= planned.stats.gouge_bound_mm + 2 * kFinest;
    if (!good || std::getenv("CUSP_PROPERTY_FIRST") != nullptr) {
        std::printf(
            "polyhedron seed %u%s: %zu triangles, R %.3f, scallop %.4f, claimed %.4f; left %.4f at "
            "(%.4f %.4f %.4f), normal (%.4f %.4f %.5f); gouge %.5f, claimed %.5f; %d passes, "
            "%.2f s\n",
            seed, good ? "" : " FAILS", operation.mesh.size(), operation.tool.radius,
            *operation.scallop, bound, worst.left > 0 ? bound + kExact + worst.left : 0.0,
            worst.place.x, worst.place.y, worst.place.z, worst.normal.x, worst.normal.y,
            worst.normal.z, gouge, planned.stats.gouge_bound_mm, planned.stats.passes,
            planned.stats.planning_s);
        for (const std::string& warning : planned.stats.warnings) {
            std::printf("  %s\n", warning.c_str());
        }
        std::fflush(stdout);
    }
    return good;
}

}  // namespace

TEST_GROUP(MeshBoundProperty){};

TEST(MeshBoundProperty, NowhereABallReachesIsMoreLeftThanThePlanClaims)
{
    const char* const first = std::getenv("CUSP_PROPERTY_FIRST");
    const int begin = first != nullptr ? std::atoi(first) : 1;
    const int cases = property_cases(8);
    int broken = 0;
    for (int i = 0; i < cases; ++i) {
        broken += holds(static_cast<unsigned>(begin + i)) ? 0 : 1;
    }
    std::printf("%d of %d polyhedra break a bound\n", broken, cases);
    LONGS_EQUAL(0, broken);
}

}  // namespace cusp::test
