// |point + R n - contact| < R': linear in n, as n has length 1.
#include "host_tools/clearing/ball_directions.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {
namespace {

double square(double a) { return a * a; }

Vec3d unit(Vec3d a) { return a * (1 / norm(a)); }

}  // namespace

BallDirections::BallDirections(Vec3d point, double radius, double contact_radius)
    : point_{point}, radius_{radius}, contact_radius_{contact_radius}
{
}

// Contacts that bar nothing are left out: most of the ground below.
void BallDirections::add(Vec3d contact)
{
    const Vec3d way = contact - point_;
    const double least =
        (dot(way, way) + square(radius_) - square(contact_radius_)) / (2 * radius_);
    const double level = std::hypot(way.x, way.y);
    const double most = way.z > 0 ? norm(way) : level;
    const bool shank = way.z > 0 && level < radius_ + contact_radius_;
    if (most > least || shank) {
        barriers_.push_back({way, std::max(0.0, least)});
    }
}

std::array<BallDirections::Triangle, 4> BallDirections::half_sphere()
{
    const Vec3d up{0, 0, 1};
    const std::array<Vec3d, 4> level{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0},
                                     Vec3d{0, -1, 0}};
    return {Triangle{up, level[0], level[1]}, Triangle{up, level[1], level[2]},
            Triangle{up, level[2], level[3]}, Triangle{up, level[3], level[0]}};
}

std::array<BallDirections::Triangle, 4> BallDirections::quarters(const Triangle& t)
{
    const Vec3d a = unit(t[1] + t[2]);
    const Vec3d b = unit(t[2] + t[0]);
    const Vec3d c = unit(t[0] + t[1]);
    return {Triangle{a, b, c}, Triangle{t[0], c, b}, Triangle{t[1], a, c}, Triangle{t[2], b, a}};
}

Vec3d BallDirections::middle(const Triangle& t) { return unit(t[0] + t[1] + t[2]); }

// What lies under the upper half of a ball round the contact is convex; the triangle lies between
// its corners and those stretched.
bool BallDirections::bars_shank(const Barrier& barrier,
                                const Triangle& triangle,
                                double stretch) const
{
    const auto under = [&](Vec3d centre) {
        const double room = square(contact_radius_) - square(centre.x - barrier.way.x) -
                            square(centre.y - barrier.way.y);
        const double over = centre.z - barrier.way.z;
        return room > 0 && (over <= 0 || square(over) < room);
    };
    return std::all_of(triangle.begin(), triangle.end(), [&](Vec3d corner) {
        return under(corner * radius_) && under(corner * (radius_ * stretch));
    });
}

// The one that does is looked at first the next time: mostly the same few do.
bool BallDirections::bars(const Triangle& t)
{
    const double lowest = radius_ * std::min({t[0].z, t[1].z, t[2].z});
    const double stretch = 3 / norm(t[0] + t[1] + t[2]);
    for (std::size_t k = 0; k < barriers_.size(); ++k) {
        const Barrier& barrier = barriers_[k];
        const auto passed = [&](Vec3d corner) {
            return dot(corner, barrier.way) > barrier.least;
        };
        const bool all = (passed(t[0]) && passed(t[1]) && passed(t[2])) ||
                         (barrier.way.z > lowest && bars_shank(barrier, t, stretch));
        if (all) {
            std::swap(barriers_[k], barriers_[k / 2]);
            return true;
        }
    }
    return false;
}

}  // namespace cusp::host
