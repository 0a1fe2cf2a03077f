// The area that a flat end mill has swept, and how much of its circumference is in stock beside it.
//
//     SweptArea swept{box, 3.0};                  // mm: radius of the tool
//     swept.add_disc({0, 0}, 4.0);                // a hole to start from
//     const double angle = swept.engagement({1.2, 0}, {0, 1});     // radians
//     const double most = swept.engagement_bound(edge, limit);     // nowhere more along the edge
//     swept.add(edge);
//
// The area is kept as discs: those of the tool at places on its path, at most kDiscSpacing radii
// apart. They lie within what the tool sweeps, so that engagement is never found too small.
// Cells of a grid that lie within a single disc are known as swept; in the others the circle is cut
// with each disc.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::adaptive_clearing {

// Not for use by two threads at once, const members included.
class SweptArea {
public:
    // In radii: the largest `shrink` of engagement().
    static constexpr double kMaxShrink = 0.09;

    // box     of the places that the tool's circle may reach
    // radius  mm, of the tool, > 0
    SweptArea(const offset::Box2d& box, double radius);

    // Precondition: a radius (mm) of at least the tool's.
    void add_disc(Vec2d centre, double radius);
    // The tool along the edge, by chords of its arcs within `tolerance` (mm).
    void add(const offset::Edge& edge, double tolerance = 0.0);

    // The engagement at `centre`, radians: how much of the tool's circle is not swept. Only the part
    // within a quarter turn and `widened` (radians) of the unit vector `heading` counts.
    //
    // shrink  mm, at most kMaxShrink radii: discs are taken as smaller by it. For the tool anywhere
    //        within `shrink` of the centre the result is an upper bound, with headings up to
    //        `widened` off. Negative: stock thinner than that does not count.
    double engagement(Vec2d centre, Vec2d heading, double shrink = 0.0, double widened = 0.0) const;

    // An upper bound, in radians, of the engagement while the tool moves along the part of the edge
    // between two shares of its length, or along chords within `tolerance` (mm). To second order in
    // the part's length: a radius of 3 mm, turned by 0.05 rad about a circle of its size, has at
    // most 0.01 mm of stock too much. Precondition: no point of the circle moves by more than
    // 2 * kMaxShrink radii.
    double engagement_of_piece(const offset::Edge& edge,
                               double from,
                               double to,
                               double tolerance = 0.0) const;

    // engagement_of_piece() for the whole edge. Pieces of the edge are halved down to 0.001 radii until
    // it is at most `limit`.
    double engagement_bound(const offset::Edge& edge, double limit, double tolerance = 0.0) const;

    // True if that is at most `limit`; ends at the first piece that is over it.
    bool keeps(const offset::Edge& edge, double limit, double tolerance = 0.0) const;

    // True if the point is swept.
    bool contains(Vec2d point) const;

    // Points in the region that are not swept: of a raster with a pitch of radius / 72, and corners
    // of what stays with discs larger by `sliver` (mm), which rasters miss where it is thin.
    std::vector<Vec2d> uncut_points(const offset::Region2d& region, double sliver) const;

    double radius() const { return radius_; }

private:
    struct Disc {
        Vec2d centre;
        double radius;
    };
    // The nearest disc of each point of a cell is among them; none where the cell is swept.
    using Discs = std::vector<std::uint32_t>;
    // Arcs of the tool's circle, as diamond angles from the heading.
    struct Interval {
        double from;
        double to;
    };
    struct Pose2d {
        Vec2d at;
        Vec2d heading;
    };
    template <typename Cover>
    double open_angle(const Pose2d& pose, double most, const Cover& cover) const;
    double open_between_covered(double end) const;
    int covered_front(const Disc& disc, const Pose2d& pose, double shrink, Interval* parts) const;
    void add_covered_at_both(const Disc& disc, const Pose2d* poses, double shrink) const;
    int next_open(std::size_t first, int i, int last) const;
    int discs_along(const offset::Edge& edge) const;
    int pieces_of(const offset::Edge& edge, double tolerance) const;
    bool is_hidden(std::uint32_t disc, std::uint32_t by, Vec2d middle) const;
    void put(std::uint32_t disc, Discs& discs, Vec2d middle) const;
    std::size_t cell_at(Vec2d point) const;
    template <typename Visit>
    void visit_corners(std::size_t cell, double more, Visit visit) const;
    std::optional<Interval> covered_by(const Disc& disc, const Pose2d& pose, double shrink) const;
    void add_covered(const Disc& disc, const Pose2d& pose, double shrink) const;
    double bound_of_piece(
        const offset::Edge& edge, double from, double to, double limit, double tolerance) const;
    bool piece_keeps(
        const offset::Edge& edge, double from, double to, double limit, double tolerance) const;

    Vec2d corner_;
    double radius_;
    double pitch_;
    double per_mm_;  // cells
    int columns_;
    int rows_;
    std::vector<std::uint8_t> is_swept_;  // cells with all points within kGrown of them
    std::vector<Discs> cells_;
    std::vector<Disc> discs_;
    // Scratch of engagement(): discs already visited, and what they cover.
    mutable std::vector<std::uint32_t> last_query_;
    mutable std::uint32_t query_{0};
    mutable std::vector<Interval> covered_;
};

}  // namespace cusp::adaptive_clearing
