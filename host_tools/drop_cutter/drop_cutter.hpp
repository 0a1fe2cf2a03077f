// Drop cutter: the lowest tip of a tool over surfaces (its CL point), and the clearance of a
// straight move. Both are computed bounds, from boxes that are halved until they are thin.
//
//     const DropCutter cutter{surfaces, tool, 0.001};
//     const DropCutter::ClPoint cl = cutter.drop({10.0, 5.0});  // cl.z: at most 0.001 too high
//     const Vec2d cc = cutter.cc_place({10.0, 5.0}, cl);        // in plan, where the tool touches
//     const double gap = cutter.move_clearance({10.0, 5.0, cl.z}, {12.0, 5.0, cl.z});
//                                                               // < 0: how deep it may gouge
//
// Every piece of a surface lies in the convex hull of its control points, so it lies below a plane
// through their highest ones. Dropping the tool on such planes bounds the true height from above;
// halving the pieces near the contact brings the bound down to the accuracy asked for. Nothing is
// iterated that could fail to converge, and the tool touches whatever is highest: several surfaces,
// walls and narrow valleys need no case of their own. Where a surface is trimmed, pieces across the
// edge end at a line along it, and are halved until nothing stands over that line by more than the
// accuracy.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/edge_gouge_check.hpp"
#include "host_tools/part_model/trim_region.hpp"
#include "host_tools/toolpath/tool.hpp"

namespace cusp::drop_cutter {

class DropCutter {
public:
    // accuracy (mm, > 0): how much too high an answer may be; never too low.
    DropCutter(const std::vector<nurbs::Surface>& surfaces,
               const toolpath::Tool& tool,
               double accuracy);

    struct ClPoint {
        double z;             // of the tip; kNoSurface where no surface lies under the tool
        Vec2d slope;          // gradient of z: that of the surface at the cutter contact
        std::uint32_t piece;  // for cc_place(), until the next question
    };
    static constexpr double kNoSurface = -1e300;

    // The tip's lowest height over (x, y), at most `accuracy` above the true one on smooth
    // surfaces; or `max_error` (mm), where that is more.
    ClPoint drop(Vec2d at, double max_error = 0.0) const;

    // Where in plan the tool over `at` touches what it rests on, as drop() found it.
    Vec2d cc_place(Vec2d at, const ClPoint& rest) const;

    // From now on what a ball cuts into rims and creases counts square to the face that ends there,
    // as a tolerance does; see `EdgeGougeCheck`. allowed (mm, > 0): how deep moves may cut.
    void check_edge_gouges(double allowed);

    // Lower bound of the gap between the tool, moved straight from tip a to tip b, and the
    // surfaces with what is below them: 0 where it keeps clear of them, negative (mm) by how much
    // it may cut; along the normal for a ball, along the axis for other tools. margin (mm, >= 0):
    // how far beside the straight line the tool may really be.
    double move_clearance(Vec3d a, Vec3d b, double margin = 0.0) const;

    // True where some surface, as far as it is not trimmed away, lies straight above or below (x,
    // y), to a tenth of the tool radius.
    bool covers(Vec2d at) const;

    // Of the surface where the tool touches it, in the plan direction `along`; curvature > 0 where
    // it is bent away from the tool (convex), 1/mm.
    struct Section {
        double curvature;  // normal curvature across the path
        double slope;      // dz/ds of the floor across the path
        double slope_along;
        bool found;
    };
    // The surface where the tool rests on it, to look at from several directions.
    struct CcPoint {
        double z;  // z of the tip
        nurbs::SurfacePoint surface;
        Vec3d normal;
        bool found;
    };
    CcPoint cc_point(Vec2d at, double max_error) const;
    // As cc_point(), which is good to the thin piece that the tool rests on; here the place on it
    // is the one that the tool touches.
    CcPoint exact_cc_point(Vec2d at, double max_error) const;
    static Section section(const CcPoint& contact, Vec2d along);

    const toolpath::Tool& tool() const { return tool_; }
    double lowest() const { return lowest_; }
    double highest() const { return highest_; }

private:
    static constexpr std::size_t kStack = 256;
    // What most queries read of a piece stands in its first cache line.
    struct alignas(64) Piece {
        // A plane above the piece, where it is a graph: z = level + gradient . (x, y).
        Vec2d gradient;
        double z_at_origin;
        double rise;  // of the tip over the plane at the tool's axis
        double z1;
        double contact;             // where the tool touches the plane: axis + gradient * contact
        double thickness;           // vertical, of the slab under that plane
        std::uint32_t child;        // 0: not yet halved
        bool graph;                 // false where too steep for a plane z(x, y)
        bool cut;                   // by the edge of a trimmed surface
        std::uint8_t border;        // which of its sides are edges of the surface, see Outline
        bool outlined;              // it ends on all sides where its outline, or else its box, does
        double x0, y0, x1, y1, z0;  // box, with z1
        // A box turned with the piece: ends along (1, 0, gx) and aside of it, made unit vectors.
        std::array<double, 4> lateral;
        double secant;      // of the plane's slope
        std::uint32_t net;  // first of its control points, v fastest; the first child takes it over
        std::uint32_t patch;
        std::uint32_t parent;
        std::uint32_t outline;   // 0: the box ends where the surface does
        std::array<float, 2> u;  // its part of the patch, as shares
        std::array<float, 2> v;
    };
    // Of a piece at the surface's edge, or a trimmed one's, which its box would stand out of: a
    // rectangle in plan along each side, (across, along) are its axes.
    struct Side {
        Vec2d across;  // outward
        double inner, outer, low, high;
        double begin, end;  // of the outer line, between those of the other sides
    };
    struct Outline {
        std::array<Side, 5> sides;  // the fifth one along the edge that cuts the piece
        std::size_t count{4};
        double bow{0.0};  // mm: of the sides, seen from above
        const Side* begin() const { return sides.data(); }
        const Side* end() const { return sides.data() + count; }
    };
    // Bits of Piece::border.
    static constexpr std::uint8_t kFirstRow = 1;
    static constexpr std::uint8_t kLastRow = 2;
    static constexpr std::uint8_t kFirstColumn = 4;
    static constexpr std::uint8_t kLastColumn = 8;
    static constexpr std::uint8_t kAllSides = 15;
    // Patches are gathered by pairs up to one root: a group is a box with two children.
    static constexpr std::uint32_t kRoot = 1;
    static constexpr std::uint32_t kGroup = 0xFFFFFFFF;  // as `patch`
    struct Patch {
        std::uint32_t surface;
        std::uint32_t rows, columns;  // of control points
        bool weighted;                // weights differ
        double u0, u1, v0, v1;
    };

    CcPoint cc_point_on(const Piece& piece, double height, double u, double v) const;
    // How far x lies outside of low to high.
    static double excess(double low, double high, double x)
    {
        return std::max(0.0, std::max(low - x, x - high));
    }
    void gather(std::uint32_t place, std::uint32_t parent, Piece* first, Piece* last);
    std::uint32_t sibling(std::uint32_t piece) const
    {
        return 2 * pieces_[pieces_[piece].parent].child + 1 - piece;
    }
    void measure(Piece& piece) const;
    // Control points of the piece being measured.
    const Vec3d* points_of(const Piece& piece) const
    {
        return patches_[piece.patch].weighted ? unweighted_.data() : &nets_[piece.net];
    }
    void measure_outline(Piece& piece) const;
    bool set_sides(const Piece& piece, Outline& outline) const;
    static void widen(Side& side, Vec2d p);
    static void end_sides(Outline& outline);
    // What an edge leaves of a piece: places, off by `off` mm at most, in whose hull it lies.
    struct Remnant {
        std::vector<Vec3d> places;
        std::size_t edge;  // from here on they are the edge's
        double off;
    };
    void measure_remnant(Piece& piece) const;
    Remnant remnant_of(const Piece& piece) const;
    static std::optional<Side> side_along(const Remnant& left, double& bow);
    double beyond_outline(const Piece& piece, Vec2d at) const;
    // The tool on a plane that ends: height of the tip, and where in plan it touches.
    struct PlaneContact {
        double height;
        Vec2d place;
    };
    PlaneContact on_outline(const Piece& piece, Vec2d at) const;
    Vec2d on_piece(const Piece& piece, Vec2d at) const;
    double apart_from_outline(const Piece& piece, Vec3d a, Vec3d b) const;
    double apart_from_plate(const Piece& piece, Vec3d a, Vec3d b) const;
    struct Domain {
        double u0, u1, v0, v1;
    };
    Domain domain_of(const Piece& piece) const;
    void trim(Piece& piece) const;
    static double extent(const Piece& piece)
    {
        return std::max({piece.x1 - piece.x0, piece.y1 - piece.y0, piece.z1 - piece.z0});
    }
    void measure_plane(Piece& piece) const;
    void halve(std::uint32_t piece) const;
    void make_room() const;
    // False where the piece, or its outline, may stand `thin` over what the surface is.
    bool is_whole(const Piece& piece, double thin) const
    {
        const bool exact = piece.outline == 0 ? !piece.cut : outlines_[piece.outline].bow <= thin;
        return exact || extent(piece) < thin;
    }
    struct Query {
        Vec2d at;
        double thin;  // mm: pieces this thin are not halved
    };
    static double over_plane(const Piece& piece, Vec2d at);
    std::uint32_t guess(Vec2d at) const;
    double bound(const Piece& piece, const Query& query, double best, bool& tight) const;
    double beside_line(const Piece& piece, const Vec3d& a, const Vec3d& b) const;
    bool overhangs(const Piece& piece) const;
    double ball_clearance(const Piece& piece, const Vec3d& a, const Vec3d& b, double margin) const;
    enum class NextLook : std::uint8_t { kNone, kHalvesOfMove, kHalvesOfPiece };
    NextLook next_look(const Piece& piece, double here, double length, double tilt) const;
    double axial_clearance(const Piece& piece, Vec3d a, Vec3d b, double margin) const;
    Vec2d slope_of(const Piece& piece, Vec2d at) const;
    double side_slope(double away) const;
    struct Rectangle {
        double x0, x1, y0, y1;
    };
    PlaneContact on_edges(const Piece& piece, Vec2d at) const;
    PlaneContact on_edges(
        const Rectangle& part, Vec2d slope, double here, double reach, Vec2d at) const;

    toolpath::Tool tool_;
    double accuracy_;
    std::vector<nurbs::Surface> surfaces_;
    std::optional<part_model::EdgeGougeCheck> edges_;
    std::vector<part_model::TrimRegion> trims_;  // of each surface; empty where none is trimmed
    std::vector<Patch> patches_;
    // Halved when first needed; a const query only makes them finer, or begins anew.
    mutable std::vector<Piece> pieces_;
    mutable std::vector<Vec3d> nets_;           // where weights differ times those
    mutable std::vector<double> weights_;       // beside nets_, as far as some differ
    mutable std::vector<Outline> outlines_{1};  // the first one stands for none
    // As they were before any was halved.
    struct Whole {
        std::vector<Piece> pieces;
        std::vector<Vec3d> nets;
        std::vector<double> weights;
        std::vector<Outline> outlines;
    };
    Whole whole_;
    mutable std::vector<Vec3d> unweighted_;  // control points of the piece being measured
    mutable std::uint32_t last_{kRoot};      // where the tool rested last
    mutable std::uint32_t beside_{kRoot};    // the smallest piece that the last move came near to
    double lowest_{1e300};
    double highest_{-1e300};
};

}  // namespace cusp::drop_cutter
