// The engagement grows with the turn to the right, and depends on the heading at once: the greatest
// turn that keeps the bound is found by bisection, and headings settle within a radius of way.
#include "host_tools/cam/adaptive_clearing/steered_pass.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

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
        centre +
        (pose.heading * elementary::sin(angle) - n * elementary::cos(angle)) * (1.0 / curvature);
    return arc_edge(pose.at, end, centre, curvature > 0.0 ? 1 : -1);
}

struct Step {
    Edge edge;
    double engagement_bound;
    double ahead;  // radians: of the second half of a step on
};

// Steps with the same turn are one edge, up to a radius of way and a third of a turn.
std::vector<Edge> joined(const std::vector<Edge>& steps, double radius)
{
    constexpr double kMostSweep = 2 * kPi / 3;
    std::vector<Edge> path;
    for (const Edge& step : steps) {
        if (path.empty() || path.back().turn != step.turn ||
            std::abs(path.back().radius - step.radius) > 1e-9 * radius ||
            length(path.back()) + length(step) > radius ||
            sweep(path.back()) + sweep(step) > kMostSweep) {
            path.push_back(step);
        } else {
            path.back().end = step.end;
        }
    }
    return path;
}

class Steering {
public:
    explicit Steering(const SteeringSpace& space) : space_{space}, radius_{space.swept.radius()} {}

    // The step with the greatest turn to the right that is allowed; none if there is none.
    //
    // A turn that may be kept up keeps passes even. One that only the tightest turn away from the
    // stock can follow leads into corners.
    std::optional<Step> next(Pose pose)
    {
        std::optional<Step> step = greatest_turn(pose, Next::kOn);
        if (step) {
            known_curvature_ = last_;
            known_ = step->ahead;
            return step;
        }
        known_curvature_ = kUnbounded;
        return greatest_turn(pose, Next::kAway);
    }

private:
    enum class Next { kOn, kAway };

    std::optional<Step> greatest_turn(Pose pose, Next after)
    {
        double right = -1.0 / (kRightTurn * radius_);
        double left = 1.0 / space_.turn_radius;
        // The turn of the step before is near, and kept where a little more is not allowed.
        std::optional<Step> best;
        bool is_right_open = true;
        const double guess = kGuess / radius_;
        for (const double near : {last_ - guess, last_, last_ + guess}) {
            if (near <= right || near >= left) {
                continue;
            }
            if (const std::optional<Step> step = allowed(pose, near, after)) {
                if (near == last_) {
                    return step;
                }
                best = step;
                left = near;
                break;
            }
            right = near;
            is_right_open = false;
        }
        if (is_right_open) {
            if (const std::optional<Step> step = allowed(pose, right, after)) {
                last_ = right;
                return step;
            }
        }
        if (!best) {
            best = allowed(pose, left, after);
        }
        for (int i = 0; best && i < kBisections && (left - right) * radius_ > kPrecision; ++i) {
            const double middle = 0.5 * (left + right);
            if (const std::optional<Step> step = allowed(pose, middle, after)) {
                best = step;
                left = middle;
            } else {
                right = middle;
            }
        }
        last_ = best ? left : last_;
        return best;
    }

    std::optional<Step> allowed(Pose pose, double curvature, Next after) const
    {
        const Edge edge = step_from(pose, curvature, radius_);
        const Pose end{edge.end, tangent_at_end(edge)};
        if (!has_room_to_turn(space_, end) ||
            !has_room_to_turn(space_, {point_on(edge, 0.5), tangent_on(edge, 0.5)})) {
            return std::nullopt;
        }
        // The look farthest ahead is the one that refuses most.
        const double left = 1.0 / space_.turn_radius;
        double ahead = 0.0;
        if (after == Next::kOn || curvature < left) {
            const Edge on = step_from(end, after == Next::kOn ? curvature : left, radius_);
            ahead = bound_of_half(on, after == Next::kOn ? 0.75 : 0.25);
        }
        if (ahead > space_.max_engagement) {
            return std::nullopt;
        }
        // The step before looked there: stock only goes.
        const bool is_known = after == Next::kOn && curvature == known_curvature_;
        const double second = is_known ? known_ : bound_of_half(edge, 0.75);
        if (second > space_.max_engagement) {
            return std::nullopt;
        }
        const double first = bound_of_half(edge, 0.25);
        if (first > space_.max_engagement) {
            return std::nullopt;
        }
        return Step{edge, std::max(first, second), ahead};
    }

    // SweptArea::engagement_bound() for the half of the edge around its point at `share`.
    double bound_of_half(const Edge& edge, double share) const
    {
        return space_.swept.engagement_of_piece(edge, share - 0.25, share + 0.25, space_.tolerance);
    }

    const SteeringSpace& space_;
    double radius_;
    double last_{0.0};
    // The engagement ahead that the step before found for a curvature.
    double known_curvature_{kUnbounded};
    double known_{};
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
    pass.path = joined(pass.path, radius);
    return pass;
}

}  // namespace cusp::adaptive_clearing
