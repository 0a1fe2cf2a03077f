// Each place is asked whether the best ball so far reaches it; where not, the ball shrinks until it
// does. In a random order that happens some ten times, however many places there are.
#include "host_tools/part_info/ball_reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "host_tools/part_model/pattern_search.hpp"

namespace cusp::part_info {

using part_model::PartModel;
using part_model::pattern_search;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kPrecision = 5e-4;  // of the radius
// Of the touching direction along the normal: a ball beside the part's border touches an edge, but
// not from above.
constexpr double kLeastFacing = 0.1;
// Of what may be left: a ball that cuts in by so much is moved aside by little more. It also allows
// for facets in front of the face that places lie on.
constexpr double kCutShare = 0.5;

// How much a ball of one radius leaves at one place.
class Leaving {
public:
    Leaving(const PartModel& model, const GroundPlace& place, Vec3d normal, double radius)
        : model_{model},
          point_{place.point},
          normal_{normal},
          ball_{1, ToolShape::kBall, radius, radius}
    {
    }

    bool at_most(double allowed)
    {
        Vec3d tip = point_ + normal_ * ball_.radius;
        tip.z -= ball_.radius;
        if (model_.is_distance_at_least(ball_, tip, -kCutShare * allowed)) {
            return true;
        }
        const Vec2d tangent = in_plan(tip);
        if (better(tangent) && least_ <= allowed) {
            return true;
        }
        look_around(in_plan(point_), allowed);
        if (least_ <= allowed) {
            return true;
        }
        if (least_ == kInfinite) {
            return false;
        }
        constexpr double kFirst = 0.25;
        const double finest = std::min(1e-4 * ball_.radius, allowed / 10);
        pattern_search(best_, kFirst * ball_.radius, finest,
                       [&](Vec2d to) { return least_ > allowed && better(to); });
        return least_ <= allowed;
    }

private:
    // Rings of places: the search has several valleys beside walls.
    void look_around(Vec2d middle, double allowed)
    {
        constexpr int kWays = 16;
        constexpr double kTurn = 2 * 3.14159265358979 / kWays;
        better(middle);
        for (const double ring : {1.0, 0.7, 0.35}) {
            for (int k = 0; k < kWays && least_ > allowed; ++k) {
                const double reach = ring * ball_.radius;
                better({middle.x + reach * std::cos(k * kTurn),
                        middle.y + reach * std::sin(k * kTurn)});
            }
        }
    }

    bool better(Vec2d at)
    {
        const double left = left_by(at);
        if (!(left < least_)) {
            return false;
        }
        least_ = left;
        best_ = at;
        return true;
    }

    // By the ball dropped there: from the place to the ball or to its shank.
    double left_by(Vec2d at) const
    {
        const double reach = norm(at - in_plan(point_));
        if (reach > 1.5 * ball_.radius) {
            return kInfinite;
        }
        const auto tip = model_.drop_height(ball_, at.x, at.y);
        const double centre = tip ? *tip + ball_.radius : -kInfinite;
        const Vec3d way{at.x - point_.x, at.y - point_.y, std::max(0.0, centre - point_.z)};
        const double length = norm(way);
        if (dot(way, normal_) < kLeastFacing * length) {
            return kInfinite;
        }
        return std::max(0.0, length - ball_.radius);
    }

    const PartModel& model_;
    Vec3d point_;
    Vec3d normal_;
    Tool ball_;
    double least_{kInfinite};
    Vec2d best_;
};

bool reaches(const PartModel& model, const GroundPlace& place, double radius, double leaves)
{
    return Leaving{model, place, place.normal, radius}.at_most(leaves) ||
           (place.two_sided && Leaving{model, place, place.normal * -1.0, radius}.at_most(leaves));
}

// The largest ball that reaches it, between one that does and one that does not.
double largest_at(const PartModel& model,
                  const GroundPlace& place,
                  double leaves,
                  double reaching,
                  double failing)
{
    while (failing > (1 + kPrecision) * reaching) {
        const double middle =
            failing > 2 * reaching ? std::sqrt(failing * reaching) : (failing + reaching) / 2;
        (reaches(model, place, middle, leaves) ? reaching : failing) = middle;
    }
    return reaching;
}

// Shuffled, always the same way.
std::vector<std::size_t> order_of(std::size_t count)
{
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::uint64_t state = 1;
    for (std::size_t k = count; k > 1; --k) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        std::swap(order[k - 1], order[(state >> 33U) % k]);
    }
    return order;
}

}  // namespace

BallReach largest_ball(const PartModel& model,
                       const std::vector<GroundPlace>& places,
                       double tolerance,
                       double most)
{
    BallReach found;
    found.leaves = tolerance;
    found.places = places.size();
    const double smallest = tolerance / 4;
    double radius = most;
    const GroundPlace* tightest = nullptr;
    std::vector<std::size_t> order = order_of(places.size());
    // The caller's first place is the likeliest.
    std::stable_partition(order.begin(), order.end(), [](std::size_t k) { return k == 0; });
    for (const std::size_t k : order) {
        const GroundPlace& place = places[k];
        if (reaches(model, place, radius, tolerance) ||
            !reaches(model, place, smallest, tolerance)) {
            continue;
        }
        radius = largest_at(model, place, tolerance, smallest, radius);
        tightest = &place;
    }
    if (tightest == nullptr) {
        return found;
    }
    found.radius = radius;
    found.at = tightest->point;
    const double finer = tolerance / 4;
    found.corner = !reaches(model, *tightest, radius / 2, finer);
    return found;
}

}  // namespace cusp::part_info
