// Facets that block approach directions of a ball over a point.
#pragma once

#include <array>
#include <bitset>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/facet_drop.hpp"

namespace cusp::finishing {

// A ball that cuts down to exactly a point has its centre on a half sphere around that point. A facet
// blocks the directions from the point in which the ball, or its shank, would cut into it. The centres
// of these balls are a convex set, since facet and tool are convex.
class BlockingFacets {
public:
    static constexpr std::size_t kMost = 256;
    using Set = std::bitset<kMost>;

    // point    on the ball's surface
    // radius   mm, of the ball that cuts
    // contact  of the ball that must not cut into a facet, of that radius or more; must outlive this
    BlockingFacets(Vec3d point, double radius, const part_model::ToolProfile& contact);

    // The facet must live as long as this. Those beyond kMost are left out.
    void add(const part_model::Facet& facet);

    // A direction from the point, and the facets that block it.
    struct Direction {
        Vec3d along;
        Set by{};
        std::size_t asked{0};  // facets
    };
    // Asks the facets that were added meanwhile.
    void ask(Direction& direction);

    using Triangle = std::array<Direction, 3>;
    // True if one facet blocks the whole spherical triangle: its sides are parts of great circles.
    // Precondition: ask() of all corners
    bool block(const Triangle& triangle);

    // Centre of the ball approached from a direction (unit vector).
    Vec3d centre(Vec3d direction) const { return point_ + direction * radius_; }

private:
    // Coordinates are relative to the point.
    struct Side {
        Vec3d from;
        Vec3d way;
        double shares;          // 1 / mm2: of a product with `way`
        double shares_in_plan;  // the same in plan; 0 where the side is upright
        Vec3d inward;
        double inside;  // mm2: of the point
    };
    struct Bounds {
        double over;  // mm: the point over the facet's plane
        Vec3d low;
        Vec3d high;
        std::array<Side, 3> sides;
    };
    struct Blocking {
        const part_model::Facet* facet;
        Vec3d middle;
        double reach;  // mm: from the middle to the farthest corner
        double top;    // mm: the highest corner
        std::size_t bounds{kNone};
    };
    static constexpr std::size_t kNone = kMost;
    const Bounds& bounds_of(Blocking& blocking);
    bool blocks(Blocking& blocking, Vec3d direction);
    class Spread;
    Vec3d nearest(const Blocking& blocking, const Bounds& bounds, Vec3d centre) const;
    bool blocks_all(const Blocking& blocking, const Bounds& bounds, const Spread& spread) const;
    bool is_cut(const Blocking& blocking, const Bounds& bounds, Vec3d centre) const;

    Vec3d point_;
    double radius_;
    const part_model::ToolProfile& contact_;
    double contact_radius_;
    std::vector<Blocking> facets_;
    std::vector<Bounds> bounds_;  // of those that were asked closely
};

}  // namespace cusp::finishing
