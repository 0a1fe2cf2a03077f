// The circles of two caps cross at two unit vectors: their dot products with both axes are given.
#include "host_tools/geometry/drop_cutter/half_sphere_cover.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::drop_cutter {
namespace {

constexpr double kOff = 1e-9;          // of a computed direction, at least
constexpr double kOfProducts = 4e-15;  // of a sum of dot products
constexpr double kParallel = 1e-8;     // squared sine of the angle between two caps
constexpr double kUpright = 0.9;       // z of a unit vector
constexpr double kLeastSum = 0.1;      // of the length of a sum of directions
constexpr std::size_t kUsual = 128;    // open directions
// From a corner of what is open into it, radians.
constexpr double kLongestStep = 0.25;
constexpr double kShortestStep = 1e-5;

// One of the circle's points: the lowest, or some point where the cap looks up or down.
Vec3d point_of_circle(const HalfSphereCover::Cap& cap)
{
    const Vec3d u = cap.towards;
    const Vec3d way = std::abs(u.z) < kUpright ? Vec3d{0, 0, -1} : Vec3d{1, 0, 0};
    const Vec3d across = way - u * dot(way, u);
    return u * cap.least +
           across * (std::sqrt(std::max(0.0, 1 - cap.least * cap.least)) / norm(across));
}

// Along the sphere from a point of the cap's circle to its middle, a unit vector.
Vec3d inwards(const HalfSphereCover::Cap& cap, Vec3d at)
{
    const Vec3d way = cap.towards - at * dot(cap.towards, at);
    return way / std::max(norm(way), kOff);
}

}  // namespace

HalfSphereCover::HalfSphereCover()
{
    open_.reserve(kUsual);
    add({{0, 0, -1}, 0});
}

bool HalfSphereCover::add(const Cap& cap)
{
    Cap added = cap;
    if (added.least >= 1) {
        return false;
    }
    for (const Cap& other : caps_) {
        const Vec3d apart = cross(other.towards, added.towards);
        const double square = dot(apart, apart);
        if (square >= kParallel) {
            continue;
        }
        // Nearly the same axis: the part of the cap round the other's.
        const bool same_way = dot(other.towards, added.towards) > 0;
        const double angle = elementary::acos(std::clamp(added.least, -1.0, 1.0)) -
                             elementary::asin(std::sqrt(square));
        if (angle <= 0 || (same_way && elementary::cos(angle) >= other.least - kOff)) {
            return false;
        }
        added = {other.towards * (same_way ? 1.0 : -1.0), elementary::cos(angle)};
    }
    for (const Cap& other : caps_) {
        add_vertices(added, other);
    }
    const Place on_circle{point_of_circle(added), kOff, added.towards * -1.0};
    if (added.least > -1 && !is_held(on_circle)) {
        open_.push_back(on_circle);
    }
    caps_.push_back(added);
    return true;
}

void HalfSphereCover::add_vertices(const Cap& cap, const Cap& other)
{
    const double along = dot(cap.towards, other.towards);
    const Vec3d across = cross(cap.towards, other.towards);
    const double square = dot(across, across);
    if (square < kParallel) {
        return;
    }
    const double of_cap = (cap.least - along * other.least) / square;
    const double of_other = (other.least - along * cap.least) / square;
    const double rest = 1 - of_cap * cap.least - of_other * other.least;
    const double error = kOfProducts / square;
    if (rest < -error) {
        return;
    }
    const double root = std::sqrt(std::max(rest, 0.0));
    const double off = kOff + error + error / std::max(root, std::sqrt(error));
    const Vec3d middle = cap.towards * of_cap + other.towards * of_other;
    const Vec3d aside = across * (root / std::sqrt(square));
    for (const Vec3d& at : {middle + aside, middle - aside}) {
        const Place place{at, off, (inwards(cap, at) + inwards(other, at)) * -1.0};
        if (!is_held(place)) {
            open_.push_back(place);
        }
    }
}

bool HalfSphereCover::is_held(const Place& place) const
{
    return std::any_of(caps_.begin(), caps_.end(), [&](const Cap& cap) {
        return dot(cap.towards, place.direction) > cap.least + place.off;
    });
}

// A cap over the middle of the open vertices takes much of what is open; one over a vertex, a corner of it.
std::optional<Vec3d> HalfSphereCover::open()
{
    open_.erase(std::remove_if(open_.begin(), open_.end(),
                               [&](const Place& place) { return is_held(place); }),
                open_.end());
    if (open_.empty()) {
        return std::nullopt;
    }
    Vec3d sum;
    for (const Place& place : open_) {
        sum = sum + place.direction;
    }
    const double length = norm(sum);
    const Place middle{length > kLeastSum ? sum / length : open_.back().direction, 0};
    return is_held(middle) ? within(open_.back()) : middle.direction;
}

// A direction well within what is open at one of its corners; the corner, if that is narrower than rounding.
Vec3d HalfSphereCover::within(const Place& corner) const
{
    const Vec3d way = corner.away - corner.direction * dot(corner.away, corner.direction);
    const double length = norm(way);
    for (double step = kLongestStep; step > kShortestStep && length > kOff; step *= 0.5) {
        const Vec3d off = corner.direction + way * (step / length);
        const Place place{off / norm(off), 0};
        if (!is_held(place)) {
            return place.direction;
        }
    }
    return corner.direction;
}

}  // namespace cusp::drop_cutter
