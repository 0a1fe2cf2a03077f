// Tests at each point whether the smallest ball so far reaches it; where it does not, bisects the
// radius. In random order that happens some ten times, whatever the number of points.
#include "host_tools/job/part_info/ball_reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/pattern_search.hpp"

namespace cusp::part_info {

using part_model::PartModel;
using part_model::pattern_search;
using part_model::ToolDistance;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kPrecision = 5e-4;  // of the radius
// Points are tested with a ball smaller by this factor: a ball that fits a fillet exactly is near
// all of it, and the test takes ten times as long. Points around the tightest are tested again.
constexpr double kAskedFor = 0.95;
constexpr double kAskedAgain = 0.995;
constexpr std::size_t kAgain = 100;
// Points that are always tested, and the number of facets that may be examined for the others.
constexpr std::size_t kFirst = 300;
constexpr double kWork = 1e8;
constexpr double kLeastWork = 1000;  // each
// Least cosine between the direction of contact and the normal: beside the part's border a ball
// touches an edge, but not from above.
constexpr double kLeastFacing = 0.1;
// As a fraction of the tolerance: contact is no gouge.
constexpr double kTouching = 0.02;

// The material that a ball of one radius leaves at one point.
class Leaving {
public:
    Leaving(const PartModel& model,
            const GroundPlace& place,
            Vec3d normal,
            double radius,
            double touching)
        : model_{model},
          point_{place.point},
          normal_{normal},
          touching_{touching},
          ball_{1, ToolShape::kBall, radius, radius}
    {
    }

    bool at_most(double allowed)
    {
        if (settles(allowed)) {
            return true;
        }
        better(in_plan(point_ + normal_ * ball_.radius));
        if (searched(allowed)) {
            return true;
        }
        least_ = kInfinite;
        look_around(in_plan(point_), allowed);
        return searched(allowed);
    }

private:
    // Starts with the ball that touches the point and repeatedly moves it out of its deepest gouge;
    // usually the result touches next to the point.
    bool settles(double allowed) const
    {
        constexpr int kPushes = 12;
        Vec3d centre = point_ + normal_ * ball_.radius;
        for (int k = 0; k < kPushes && left_at(centre) <= allowed - touching_; ++k) {
            const Vec3d tip = centre - Vec3d{0, 0, ball_.radius};
            if (model_.is_distance_at_least(ball_, tip, -touching_)) {
                return true;
            }
            const ToolDistance cut = model_.distance(ball_, tip, 0);
            Vec3d way = centre - cut.nearest.point;
            way.z = std::max(0.0, way.z);  // the shank gouges sideways
            const double length = norm(way);
            if (!(length > 0) || !(cut.distance < 0)) {
                return false;
            }
            centre = centre + way * (-cut.distance / length);
        }
        return false;
    }

    // Starts at the best position so far; ends as soon as no more than `allowed` is left.
    bool searched(double allowed)
    {
        constexpr double kFirstStep = 0.25;
        if (least_ > allowed && least_ < kInfinite) {
            const double finest = std::min(1e-5 * ball_.radius, allowed / 10);
            pattern_search(best_, kFirstStep * ball_.radius, finest,
                           [&](Vec2d to) { return least_ > allowed && better(to); });
        }
        return least_ <= allowed;
    }

    // Samples rings of positions: beside walls there are several local minima.
    void look_around(Vec2d middle, double allowed)
    {
        constexpr int kWays = 16;
        constexpr double kTurn = 2 * 3.14159265358979 / kWays;
        better(middle);
        for (const double ring : {1.0, 0.7, 0.35}) {
            for (int k = 0; k < kWays && least_ > allowed; ++k) {
                const double reach = ring * ball_.radius;
                better({middle.x + reach * elementary::cos(k * kTurn),
                        middle.y + reach * elementary::sin(k * kTurn)});
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

    // After dropping the ball at `at`: the distance from the point to the ball or its shank.
    double left_by(Vec2d at) const
    {
        const double reach = norm(at - in_plan(point_));
        if (reach > 1.5 * ball_.radius) {
            return kInfinite;
        }
        const auto tip = model_.drop_height(ball_, at.x, at.y);
        return left_at({at.x, at.y, tip ? *tip + ball_.radius : -kInfinite});
    }

    // By a ball with this centre.
    double left_at(Vec3d centre) const
    {
        const Vec3d way{centre.x - point_.x, centre.y - point_.y,
                        std::max(0.0, centre.z - point_.z)};
        const double length = norm(way);
        if (dot(way, normal_) < kLeastFacing * length) {
            return kInfinite;
        }
        return std::max(0.0, length - ball_.radius);
    }

    const PartModel& model_;
    Vec3d point_;
    Vec3d normal_;
    double touching_;
    Tool ball_;
    double least_{kInfinite};
    Vec2d best_;
};

// Model, facets and tolerance of a trial.
struct Trial {
    const PartModel& model;
    double leaves;
    double touching;

    bool reaches(const GroundPlace& place, double radius) const
    {
        const auto from = [&](Vec3d side) {
            return Leaving{model, place, side, radius, touching}.at_most(leaves);
        };
        return from(place.normal) || (place.two_sided && from(place.normal * -1.0));
    }

    // Bisects for the largest radius that reaches the point.
    double largest_at(const GroundPlace& place, double reaching, double failing) const
    {
        // Small balls first: a large ball that does not reach the point takes long.
        while (failing > 2 * reaching && reaches(place, 2 * reaching)) {
            reaching *= 2;
        }
        failing = std::min(failing, 2 * reaching);
        while (failing > (1 + kPrecision) * reaching) {
            const double middle = (failing + reaching) / 2;
            (reaches(place, middle) ? reaching : failing) = middle;
        }
        return reaching;
    }
};

// The first points in their order, the others shuffled with a fixed seed.
std::vector<std::size_t> order_of(std::size_t count)
{
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::uint64_t state = 1;
    for (std::size_t k = count; k > kFirst + 1; --k) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        std::swap(order[k - 1], order[kFirst + (state >> 33U) % (k - kFirst)]);
    }
    return order;
}

// The fraction of points near the ball that touches `place`: an estimate of the facets that a
// search for its gouges has to examine.
double share_near(const std::vector<GroundPlace>& places, const GroundPlace& place, double radius)
{
    constexpr double kNear = 0.1;  // of the radius
    const Vec3d centre = place.point + place.normal * radius;
    const auto near = std::count_if(places.begin(), places.end(), [&](const GroundPlace& other) {
        return std::abs(norm(other.point - centre) - radius) < kNear * radius;
    });
    return static_cast<double>(near) / static_cast<double>(places.size());
}

}  // namespace

BallReach largest_ball(const PartModel& model,
                       const std::vector<GroundPlace>& places,
                       double tolerance,
                       double facets_off,
                       std::size_t facets,
                       double max_radius)
{
    const Trial trial{model, tolerance, facets_off + kTouching * tolerance};
    BallReach found;
    found.leaves = tolerance;
    const double smallest = tolerance / 4;
    double radius = max_radius;
    const GroundPlace* tightest = nullptr;
    const auto ask = [&](const std::vector<std::size_t>& order, std::size_t begin, std::size_t end,
                         double share) {
        for (std::size_t at = begin; at < end; ++at) {
            const GroundPlace& place = places[order[at]];
            ++found.places;
            if (!trial.reaches(place, share * radius) && trial.reaches(place, smallest)) {
                radius = trial.largest_at(place, smallest, share * radius);
                tightest = &place;
            }
        }
    };
    std::vector<std::size_t> order = order_of(places.size());
    const std::size_t first = std::min(kFirst, places.size());
    ask(order, 0, first, kAskedFor);
    const double near = tightest == nullptr ? 0 : share_near(places, *tightest, radius);
    const double each = kLeastWork + near * static_cast<double>(facets);
    const std::size_t most_places =
        std::min(places.size(), std::max(first, static_cast<std::size_t>(kWork / each)));
    ask(order, first, most_places, kAskedFor);
    if (tightest == nullptr) {
        return found;
    }
    const Vec3d middle = tightest->point;
    const std::size_t again = std::min({kAgain, order.size(), most_places / 10 + 1});
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(again),
                      order.end(), [&](std::size_t a, std::size_t b) {
                          return std::make_pair(norm(places[a].point - middle), a) <
                                 std::make_pair(norm(places[b].point - middle), b);
                      });
    ask(order, 0, again, kAskedAgain);
    found.radius = radius;
    found.at = tightest->point;
    const Trial finer{model, tolerance / 4, std::min(tolerance / 8, trial.touching)};
    found.corner = radius < 2 * tolerance || !finer.reaches(*tightest, radius / 2);
    return found;
}

}  // namespace cusp::part_info
