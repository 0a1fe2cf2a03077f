// A ball round the facet decides first, then its plane, then its sides; the shank is rarely asked.
#include "host_tools/cam/finishing/blocking_facets.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/approach_directions.hpp"

namespace cusp::finishing {

using drop_cutter::ApproachDirections;
using part_model::Facet;

namespace {

constexpr double kUpright = 1e-9;  // z of a normal

double square(double a) { return a * a; }

}  // namespace

BlockingFacets::BlockingFacets(Vec3d point, double radius, const part_model::ToolProfile& contact)
    : point_{point}, radius_{radius}, contact_{contact}, contact_radius_{contact.radius()}
{
}

void BlockingFacets::add(const Facet& facet)
{
    if (facets_.size() == kMost) {
        return;
    }
    const std::array<Vec3d, 3>& at = facet.corners;
    const Vec3d middle = (at[0] + at[1] + at[2]) / 3.0;
    const double reach =
        std::max({norm(at[0] - middle), norm(at[1] - middle), norm(at[2] - middle)});
    facets_.push_back(
        {&facet, middle - point_, reach, std::max({at[0].z, at[1].z, at[2].z}) - point_.z});
}

const BlockingFacets::Bounds& BlockingFacets::bounds_of(Blocking& blocking)
{
    if (blocking.bounds != kNone) {
        return bounds_[blocking.bounds];
    }
    const Facet& facet = *blocking.facet;
    const std::array<Vec3d, 3>& at = facet.corners;
    const double turn = dot(cross(at[1] - at[0], at[2] - at[0]), facet.normal);
    Bounds out{dot(point_ - at[0], facet.normal), at[0] - point_, at[0] - point_, {}};
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Vec3d from = at[k] - point_;
        out.low = {std::min(out.low.x, from.x), std::min(out.low.y, from.y),
                   std::min(out.low.z, from.z)};
        out.high = {std::max(out.high.x, from.x), std::max(out.high.y, from.y),
                    std::max(out.high.z, from.z)};
        const Vec3d way = at[(k + 1) % at.size()] - at[k];
        const Vec3d inward = cross(facet.normal, way) * (turn < 0 ? -1.0 : 1.0);
        const double in_plan = way.x * way.x + way.y * way.y;
        out.sides[k] = {from,
                        way,
                        1 / dot(way, way),
                        in_plan > 0 ? 1 / in_plan : 0,
                        inward,
                        -dot(inward, from)};
    }
    blocking.bounds = bounds_.size();
    bounds_.push_back(out);
    return bounds_.back();
}

bool BlockingFacets::blocks(Blocking& blocking, Vec3d direction)
{
    const Vec3d centre = direction * radius_;
    const Vec3d off = centre - blocking.middle;
    const double away = dot(off, off);
    if (away < square(contact_radius_)) {
        return true;
    }
    if (away >= square(contact_radius_ + blocking.reach) && blocking.top <= centre.z) {
        return false;
    }
    return is_cut(blocking, bounds_of(blocking), centre);
}

// True if the ball with its shank cuts into the facet.
bool BlockingFacets::is_cut(const Blocking& blocking, const Bounds& bounds, Vec3d centre) const
{
    const Vec3d normal = blocking.facet->normal;
    const double over = bounds.over + dot(normal, centre);
    if (over >= contact_radius_ || (normal.z < kUpright && over <= -contact_radius_)) {
        return false;
    }
    const double x = std::max({bounds.low.x - centre.x, centre.x - bounds.high.x, 0.0});
    const double y = std::max({bounds.low.y - centre.y, centre.y - bounds.high.y, 0.0});
    if (x * x + y * y >= square(contact_radius_)) {
        return false;
    }
    const auto any_side = [&](const auto& is) {
        return std::any_of(bounds.sides.begin(), bounds.sides.end(), is);
    };
    const auto outside = [&](const Side& side) {
        return side.inside + dot(side.inward, centre) < 0;
    };
    if (over > -contact_radius_ && !any_side(outside)) {
        return true;
    }
    const auto touched = [&](const Side& side) {
        const Vec3d from = centre - side.from;
        const double share = std::clamp(dot(from, side.way) * side.shares, 0.0, 1.0);
        const Vec3d off = from - side.way * share;
        return dot(off, off) < square(contact_radius_);
    };
    if (any_side(touched)) {
        return true;
    }
    if (blocking.top <= centre.z) {
        return false;
    }
    // The shank reaches what is above the centre and nearest to it in plan.
    const auto touched_by_shank = [&](const Side& side) {
        const Vec3d from = centre - side.from;
        const double share =
            std::clamp((from.x * side.way.x + from.y * side.way.y) * side.shares_in_plan, 0.0, 1.0);
        const Vec3d off = from - side.way * share;
        return off.z <= 0 && off.x * off.x + off.y * off.y < square(contact_radius_);
    };
    if (any_side(touched_by_shank)) {
        return true;
    }
    const Vec3d at = point_ + centre;
    const auto rest = part_model::drop_on_facet(*blocking.facet, contact_, at.x, at.y, at.z);
    return rest && rest->centre > at.z;
}

void BlockingFacets::ask(Direction& direction)
{
    for (; direction.asked < facets_.size(); ++direction.asked) {
        direction.by[direction.asked] = blocks(facets_[direction.asked], direction.along);
    }
}

// A spherical triangle, and how far it goes along a vector.
class BlockingFacets::Spread {
public:
    explicit Spread(const Triangle& triangle)
        : corners_{triangle[0].along, triangle[1].along, triangle[2].along}
    {
        for (std::size_t k = 0; k < 3; ++k) {
            across_[k] = cross(corners_[k], corners_[(k + 1) % 3]);
        }
    }

    const std::array<Vec3d, 3>& corners() const { return corners_; }

    // The greatest dot product of a direction of the triangle with a vector: at a corner, along a side, or in
    // the middle.
    double greatest(Vec3d vector) const
    {
        double most = -kInfinite;
        int left = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d from = corners_[k];
            const Vec3d to = corners_[(k + 1) % 3];
            const Vec3d across = across_[k];
            most = std::max(most, dot(from, vector));
            const double beside = dot(across, vector);
            left += beside > 0 ? 1 : -1;
            const Vec3d turned = cross(across, vector);
            // The vector's part along the great circle lies between its ends.
            if (dot(turned, from) < 0 && dot(turned, to) > 0) {
                most = std::max(most, norm(turned) / norm(across));
            }
        }
        return left == 3 || left == -3 ? norm(vector) : most;
    }

    double least(Vec3d vector) const { return -greatest(-vector); }

    Vec3d middle() const
    {
        const Vec3d sum = corners_[0] + corners_[1] + corners_[2];
        return sum / norm(sum);
    }

private:
    std::array<Vec3d, 3> corners_;
    std::array<Vec3d, 3> across_;
};

// True if the ball cuts into the inner part of the facet, or into the point of it that is nearest to its middle
// position, from all directions: both are linear in the direction.
bool BlockingFacets::blocks_all(const Blocking& blocking,
                                const Bounds& bounds,
                                const Spread& spread) const
{
    const Vec3d normal = blocking.facet->normal;
    if (bounds.over + radius_ * spread.greatest(normal) < contact_radius_ &&
        bounds.over + radius_ * spread.least(normal) > -contact_radius_ &&
        std::all_of(bounds.sides.begin(), bounds.sides.end(), [&](const Side& side) {
            return side.inside + radius_ * spread.least(side.inward) >= 0;
        })) {
        return true;
    }
    const Vec3d contact = nearest(blocking, bounds, spread.middle() * radius_);
    return square(radius_) + dot(contact, contact) - 2 * radius_ * spread.least(contact) <
           square(contact_radius_);
}

// The facet's point nearest to the centre.
Vec3d BlockingFacets::nearest(const Blocking& blocking, const Bounds& bounds, Vec3d centre) const
{
    if (std::all_of(bounds.sides.begin(), bounds.sides.end(), [&](const Side& side) {
            return side.inside + dot(side.inward, centre) >= 0;
        })) {
        const Vec3d normal = blocking.facet->normal;
        return centre - normal * (bounds.over + dot(normal, centre));
    }
    Vec3d best;
    double least = kInfinite;
    for (const Side& side : bounds.sides) {
        const double share = std::clamp(dot(centre - side.from, side.way) * side.shares, 0.0, 1.0);
        const Vec3d place = side.from + side.way * share;
        const Vec3d off = centre - place;
        if (dot(off, off) < least) {
            least = dot(off, off);
            best = place;
        }
    }
    return best;
}

bool BlockingFacets::block(const Triangle& triangle)
{
    const Set common = triangle[0].by & triangle[1].by & triangle[2].by;
    if (common.none()) {
        return false;
    }
    const Spread spread{triangle};
    const ApproachDirections::Triangle beyond = ApproachDirections::stretched(spread.corners());
    for (std::size_t k = 0; k < facets_.size(); ++k) {
        if (common[k] && (blocks_all(facets_[k], bounds_of(facets_[k]), spread) ||
                          std::all_of(beyond.begin(), beyond.end(),
                                      [&](Vec3d corner) { return blocks(facets_[k], corner); }))) {
            return true;
        }
    }
    return false;
}

}  // namespace cusp::finishing
