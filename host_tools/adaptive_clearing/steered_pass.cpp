// The engagement grows with the turn to the right, and depends on the heading at once: the greatest
// turn that keeps the bound is found by bisection, and headings settle within a radius of way.
#include "host_tools/adaptive_clearing/steered_pass.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cusp::adaptive_clearing {

using offset::arc_edge;
using offset::Edge;
using offset::left_normal;
using offset::length;
using offset::line_edge;
using offset::point_on;
using offset::tangent_at_end;
using offset::tangent_on;

namespace {

constexpr double kStep = 0.1;             // radii
constexpr double kMostTurn = 0.25;        // radians a step
constexpr double kRightTurn = 1.0;        // radii: the tightest turn towards stock
constexpr double kSliver = 0.01;          // radii
constexpr double kLongestAir = 0.5;       // radii of way without stock
constexpr double kBarely = 0.02;          // radians: less is no cut
constexpr double kLeastCurvature = 1e-4;  // of 1 / radius: else a line
constexpr double kGuess = 0.04;           // of 1 / radius
constexpr double kPrecision = 0.021;
constexpr int kBisections = 8;
constexpr int kMostSteps = 2000000;

// curvature  1/mm, positive to the left
Edge step_from(Pose pose, double curvature, double radius)
{
    const double size = std::abs(curvature);
    if (size < kLeastCurvature / radius) {
        return line_edge(pose.at, pose.at + pose.heading * (kStep * radius));
    }
    const double angle = std::min(kStep * radius * size, kMostTurn) * (curvature > 0.0 ? 1 : -1);
    const Vec2d n = left_normal(pose.heading);
    const Vec2d centre = pose.at + n * (1.0 / curvature);
    const Vec2d end =
        centre + (pose.heading * std::sin(angle) - n * std::cos(angle)) * (1.0 / curvature);
    return arc_edge(pose.at, end, centre, curvature > 0.0 ? 1 : -1);
}

struct Step {
    Edge edge;
    double engagement_bound;
};

class Steering {
public:
    explicit Steering(const SteeringSpace& space) : space_{space}, radius_{space.swept.radius()} {}

    // The step with the greatest turn to the right that is allowed; none if there is none.
    std::optional<Step> next(Pose pose)
    {
        double right = -1.0 / (kRightTurn * radius_);
        double left = 1.0 / space_.turn_radius;
        // The turn of the step before is near.
        std::optional<Step> best;
        bool is_right_open = true;
        const double guess = kGuess / radius_;
        for (const double near : {last_ - guess, last_ + guess}) {
            if (near <= right || near >= left) {
                continue;
            }
            if (std::optional<Step> edge = allowed(pose, near)) {
                best = edge;
                left = near;
                break;
            }
            right = near;
            is_right_open = false;
        }
        if (is_right_open) {
            if (std::optional<Step> edge = allowed(pose, right)) {
                last_ = right;
                return edge;
            }
        }
        if (!best) {
            best = allowed(pose, left);
        }
        for (int i = 0; best && i < kBisections && (left - right) * radius_ > kPrecision; ++i) {
            const double middle = 0.5 * (left + right);
            if (std::optional<Step> edge = allowed(pose, middle)) {
                best = edge;
                left = middle;
            } else {
                right = middle;
            }
        }
        last_ = left;
        return best;
    }

private:
    std::optional<Step> allowed(Pose pose, double curvature) const
    {
        const Edge edge = step_from(pose, curvature, radius_);
        const Pose end{edge.end, tangent_at_end(edge)};
        if (!has_room_to_turn(space_, end) ||
            !has_room_to_turn(space_, {point_on(edge, 0.5), tangent_on(edge, 0.5)})) {
            return std::nullopt;
        }
        const double second = bound_of_half(edge, 0.75);
        const double first = second > space_.max_engagement ? second : bound_of_half(edge, 0.25);
        if (first > space_.max_engagement) {
            return std::nullopt;
        }
        // From its end there is a way on: away from the stock as tightly as may be.
        const double left = 1.0 / space_.turn_radius;
        if (curvature < left &&
            bound_of_half(step_from(end, left, radius_), 0.25) > space_.max_engagement) {
            return std::nullopt;
        }
        return Step{edge, std::max(first, second)};
    }

    // Of the half of the edge about its place at `share`, as SweptArea::engagement_bound().
    double bound_of_half(const Edge& edge, double share) const
    {
        return space_.swept.engagement(
            point_on(edge, share), tangent_on(edge, share),
            0.25 * length(edge) + (edge.turn != 0 ? space_.tolerance : 0.0), 0.25 * sweep(edge));
    }

    const SteeringSpace& space_;
    double radius_;
    double last_{0.0};
};

}  // namespace

bool has_room_to_turn(const SteeringSpace& space, Pose pose)
{
    const Vec2d centre = pose.at + left_normal(pose.heading) * space.turn_radius;
    return !space.walls.any_nearer(centre, space.wall_clearance + space.turn_radius - 1e-7);
}

SteeredPass steered_pass(const SteeringSpace& space, Pose pose)
{
    const double radius = space.swept.radius();
    Steering steering{space};
    SteeredPass pass;
    std::size_t cut = 0;  // edges up to the last one in stock: only these are made, and swept
    double air = 0.0;
    for (int i = 0; i < kMostSteps && air < kLongestAir * radius; ++i) {
        const std::optional<Step> step = steering.next(pose);
        if (!step) {
            break;
        }
        const Edge& edge = step->edge;
        const bool in_stock = space.swept.engagement(point_on(edge, 0.5), tangent_on(edge, 0.5),
                                                     -kSliver * radius) > kBarely;
        pass.path.push_back(edge);
        pass.engagement_bound = std::max(pass.engagement_bound, step->engagement_bound);
        pose = {edge.end, tangent_at_end(edge)};
        if (in_stock) {
            for (; cut < pass.path.size(); ++cut) {
                space.swept.add(pass.path[cut], space.tolerance);
            }
            air = 0.0;
        } else {
            air += length(edge);
        }
    }
    pass.path.resize(cut);
    return pass;
}

}  // namespace cusp::adaptive_clearing
