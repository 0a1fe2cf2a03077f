// A contact blocks n where |point + R n - contact| < R', which is linear in n since |n| = 1.
#include "host_tools/geometry/drop_cutter/approach_directions.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::drop_cutter {
namespace {

Vec3d unit(Vec3d a) { return a * (1 / norm(a)); }

}  // namespace

ApproachDirections::ApproachDirections(Vec3d point, double radius, double contact_radius)
    : point_{point}, radius_{radius}, contact_radius_{contact_radius}
{
}

ApproachDirections::BlockedCap ApproachDirections::blocked_cap(std::size_t contact) const
{
    const Vec3d way = contacts_[contact] - point_;
    const double least =
        (dot(way, way) + radius_ * radius_ - contact_radius_ * contact_radius_) / (2 * radius_);
    return {way, std::max(0.0, least), contact};
}

// Contacts that block nothing, such as most below the point, are left out.
std::size_t ApproachDirections::add(Vec3d contact)
{
    contacts_.push_back(contact);
    const BlockedCap added = blocked_cap(contacts_.size() - 1);
    const Vec3d way = added.direction;
    const double horizontal = elementary::hypot(way.x, way.y);
    const double most = way.z > 0 ? norm(way) : horizontal;
    const bool shank = way.z > 0 && horizontal < radius_ + contact_radius_;
    if (most > added.least || shank) {
        blocked_caps_.push_back(added);
    }
    return added.contact;
}

std::array<ApproachDirections::Triangle, 4> ApproachDirections::half_sphere()
{
    const Vec3d up{0, 0, 1};
    const std::array<Vec3d, 4> horizontal{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0},
                                          Vec3d{0, -1, 0}};
    return {Triangle{up, horizontal[0], horizontal[1]}, Triangle{up, horizontal[1], horizontal[2]},
            Triangle{up, horizontal[2], horizontal[3]}, Triangle{up, horizontal[3], horizontal[0]}};
}

std::array<ApproachDirections::Triangle, 4> ApproachDirections::quarters(const Triangle& t)
{
    const Vec3d a = unit(t[1] + t[2]);
    const Vec3d b = unit(t[2] + t[0]);
    const Vec3d c = unit(t[0] + t[1]);
    return {Triangle{a, b, c}, Triangle{t[0], c, b}, Triangle{t[1], a, c}, Triangle{t[2], b, a}};
}

Vec3d ApproachDirections::middle(const Triangle& t) { return unit(t[0] + t[1] + t[2]); }

ApproachDirections::Triangle ApproachDirections::stretched(const Triangle& t)
{
    const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
    const double stretch = norm(across) / std::abs(dot(across, t[0]));
    return {t[0] * stretch, t[1] * stretch, t[2] * stretch};
}

// The points below the upper half of a ball around the contact form a convex set.
bool ApproachDirections::blocks_shank(const BlockedCap& cap, const Triangle& triangle) const
{
    const auto under = [&](Vec3d centre) {
        const Vec3d aside = centre - cap.direction;
        const double room =
            contact_radius_ * contact_radius_ - aside.x * aside.x - aside.y * aside.y;
        const double over = centre.z - cap.direction.z;
        return room > 0 && (over <= 0 || over * over < room);
    };
    // Fast rejection: usually some corner is not.
    for (const Vec3d& corner : triangle) {
        if (!under(corner * radius_)) {
            return false;
        }
    }
    const Triangle beyond = stretched(triangle);
    return std::all_of(beyond.begin(), beyond.end(),
                       [&](Vec3d corner) { return under(corner * radius_); });
}

bool ApproachDirections::blocks(const BlockedCap& cap, const Triangle& t) const
{
    const auto passed = [&](Vec3d corner) {
        return dot(corner, cap.direction) > cap.least;
    };
    return (passed(t[0]) && passed(t[1]) && passed(t[2])) ||
           (cap.direction.z > radius_ * std::min({t[0].z, t[1].z, t[2].z}) && blocks_shank(cap, t));
}

bool ApproachDirections::blocks(std::size_t contact, const Triangle& triangle) const
{
    return blocks(blocked_cap(contact), triangle);
}

// A contact that blocks moves to the front: usually the same few block the next triangle.
std::optional<std::size_t> ApproachDirections::blocking(const Triangle& triangle)
{
    for (std::size_t k = 0; k < blocked_caps_.size(); ++k) {
        if (blocks(blocked_caps_[k], triangle)) {
            const std::size_t contact = blocked_caps_[k].contact;
            std::swap(blocked_caps_[k], blocked_caps_[k / 2]);
            return contact;
        }
    }
    return std::nullopt;
}

}  // namespace cusp::drop_cutter
