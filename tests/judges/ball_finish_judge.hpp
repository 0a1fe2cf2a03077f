// True if a ball left more than is claimed or cut deeper, judged by brute force at random places.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "firmware/base/math.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/judges/ball_on_triangles.hpp"

namespace cusp::test {

constexpr int kJudgedPlaces = 1500;    // of a part
constexpr double kFinest = 1e-4;       // mm: of positions
constexpr double kPositions = 0.1;     // radii: pitch of the first ones
constexpr double kGougeStep = 0.2;     // mm
constexpr double kUprightWall = 2e-3;  // z of a normal
constexpr double kBesideWall = 1e-4;   // mm

// The place where most is left.
struct Worst {
    double left{};  // mm, over what is claimed
    Vec3d place;
    Vec3d normal;
    int reached{};  // places beside walls that were judged
};

// Judges the passes of a ball over triangles: places of the part are looked at one by one, and the
// best position of the ball over each is searched without the planner's proofs.
class BallFinishJudge {
public:
    // moves     of a ball of `radius` mm, kept while the judge is used
    // clear_of  mm: how far off the part its passes may keep
    BallFinishJudge(const Triangles& mesh, const CutMoves& moves, double radius, double clear_of)
        : mesh_{mesh}, part_{mesh_}, moves_{moves}, radius_{radius}, clear_of_{clear_of}
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

    // From now on only places for which it holds are judged, by the place and its normal.
    void judge_only(std::function<bool(Vec3d, Vec3d)> judged) { judged_ = std::move(judged); }

    // The one of `places` where most is left over the bound.
    Worst most_left(Random& random, double bound) const
    {
        Worst worst;
        for (int k = 0; k < kJudgedPlaces; ++k) {
            const std::size_t facet = k % 2 == 0 ? by_area(random) : by_chance(random);
            const Vec3d place = place_on(random, mesh_[facet]);
            const Vec3d normal = BallOnTriangles::normal(mesh_[facet]);
            if (!(normal.z > 1e-6) || !judged_(place, normal) ||
                part_.top(place.x, place.y) > place.z + 1e-6) {
                continue;
            }
            const double over = left_over(place, normal, bound) - bound;
            if (over > worst.left) {
                worst = {over, place, normal};
            }
        }
        return worst;
    }

    // The place beside a vertical wall, or one that hardly leans, where most is left over the bound,
    // of places that the side of a ball reaches which rests on something.
    Worst most_left_beside_walls(Random& random, double bound) const
    {
        std::vector<std::size_t> walls;
        for (std::size_t k = 0; k < mesh_.size(); ++k) {
            if (std::abs(BallOnTriangles::normal(mesh_[k]).z) < kUprightWall) {
                walls.push_back(k);
            }
        }
        Worst worst;
        for (int k = 0; k < kJudgedPlaces && !walls.empty(); ++k) {
            const std::size_t facet = walls[static_cast<std::size_t>(
                whole(random, 0, static_cast<int>(walls.size()) - 1))];
            const Vec3d place = place_on(random, mesh_[facet]);
            const Vec3d normal = BallOnTriangles::normal(mesh_[facet]);
            if (!judged_(place, {normal.x, normal.y, std::abs(normal.z)})) {
                continue;
            }
            for (const double side : {1.0, -1.0}) {
                const Vec3d out = normal * side;
                const Vec3d beside = place + out * kBesideWall;
                const Vec3d axis = place + out * (radius_ + clear_of_ + kBesideWall);
                const double lowest = drop(axis.x, axis.y);
                if (part_.top(beside.x, beside.y) > place.z || !std::isfinite(lowest) ||
                    lowest > place.z) {
                    continue;
                }
                const double over = moves_.depth(beside) - bound;
                const int reached = worst.reached + 1;
                if (over > worst.left) {
                    worst = {over, place, out};
                }
                worst.reached = reached;
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
    std::function<bool(Vec3d, Vec3d)> judged_{[](Vec3d, Vec3d) {
        return true;
    }};
    double clear_of_;            // mm: clearance of the ball by a one-sided tolerance
    std::vector<double> areas_;  // of the facets up to each
    std::vector<double> centres_;
    Vec3d low_;
    double pitch_{};
    int nx_{};
    int ny_{};
};

}  // namespace cusp::test
