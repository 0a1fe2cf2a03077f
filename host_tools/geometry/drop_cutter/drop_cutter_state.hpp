// State of a drop cutter: the tree of pieces, halved when needed, and the bounds of one piece.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/part_model/edge_gouge_check.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::drop_cutter {

struct DropCutter::State {
    State(const std::vector<nurbs::Surface>& surfaces, const toolpath::Tool& tool, double accuracy);
    // As `other` was before any query, edge gouges aside.
    struct ForThread {};
    State(const State& other, ForThread tag);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // The queries of DropCutter.
    std::optional<ClPoint> drop(Vec2d at, double max_error);
    Vec2d cc_place(Vec2d at, const ClPoint& cl) const;
    void check_edge_gouges(double allowed);
    double move_clearance(Vec3d a, Vec3d b, double margin);
    bool covers(Vec2d at);
    std::optional<CcPoint> cc_point(Vec2d at, double max_error);
    std::optional<CcPoint> exact_cc_point(Vec2d at, double max_error);

    static constexpr std::size_t kStack = 256;
    // Most queries read only the first cache line of a piece.
    struct alignas(64) Piece {
        // A plane above the piece, where the piece is a graph: z = z_at_origin + gradient . (x, y).
        // For a wall the plane is n . p = z_at_origin, with the unit normal n and n.z = rise;
        // `gradient` is that of the piece that was halved.
        Vec2d gradient;
        double z_at_origin;
        double rise;  // mm: of the tip over the plane at the tool's axis
        double z1;
        double contact;       // the tool touches the plane at axis + gradient * contact
        double thickness;     // mm, vertical: the piece lies in a slab so thick under the plane
        std::uint32_t child;  // first of two halves; 0: not yet halved
        bool graph;           // false where the piece is too steep for a plane z(x, y)
        bool cut;             // by the edge of a trimmed surface
        std::uint8_t border;  // bits: which of its sides are edges of the surface
        bool outlined;        // it fills its outline, or without one its box, to all sides
        double x0, y0, x1, y1, z0;  // box, with z1
        // A box turned with the piece: its ends along (1, 0, g.x) and across that in the plane,
        // both as unit vectors. Ends of a wall, which is too steep for z(x, y), along and across
        // `uphill` in plan.
        std::array<double, 4> lateral;
        Vec2d uphill;       // of a wall: the unit vector in plan along which it rises; 0: not known
        double secant;      // of the plane's slope
        std::uint32_t net;  // index of its first control point, v fastest; the first half reuses it
        std::uint32_t patch;
        std::uint32_t parent;
        std::uint32_t outline;   // 0: the piece ends at its box
        std::array<float, 2> u;  // its part of the patch, from 0 to 1
        std::array<float, 2> v;
    };
    // A side of a piece at the surface's edge, or at a trim: a rectangle in plan with the axes
    // (across, left_normal(across)).
    struct Side {
        Vec2d across;           // outward, a unit vector
        double inner, outer;    // extent along `across`
        double low, high;       // extent along left_normal(across)
        double begin{}, end{};  // of the outer line, between those of the other sides
        static Side none(Vec2d across)
        {
            return {across, kUnbounded, -kUnbounded, kUnbounded, -kUnbounded};
        }
    };
    // Ends of a piece whose box extends beyond it.
    struct Outline {
        // The fifth is the line along the edge that cuts the piece. A sliver has only four, along
        // its edge and across.
        std::array<Side, 5> sides;
        std::size_t count{4};
        double bow{0.0};  // mm, in plan: how far the piece's edge lies inside the sides at most
        const Side* begin() const { return sides.data(); }
        const Side* end() const { return sides.data() + count; }
    };
    // Bits of Piece::border.
    static constexpr std::uint8_t kFirstRow = 1;
    static constexpr std::uint8_t kLastRow = 2;
    static constexpr std::uint8_t kFirstColumn = 4;
    static constexpr std::uint8_t kLastColumn = 8;
    static constexpr std::uint8_t kAllSides = 15;
    // Patches are grouped by pairs up to one root: a group is a box with two children.
    static constexpr std::uint32_t kRoot = 1;
    static constexpr std::uint32_t kGroup = 0xFFFFFFFF;  // as `patch`
    struct Patch {
        std::uint32_t surface;
        std::uint32_t rows, columns;  // of control points
        bool weighted;                // weights differ
        double u0, u1, v0, v1;
    };
    struct Domain {
        double u0, u1, v0, v1;
    };
    // The part of a piece inside the trims: points, wrong by at most `error` mm, in whose hull it lies.
    struct Remnant {
        std::vector<Vec3d> points;
        std::size_t edge;  // from this index on they are points of the edge
        double error;
    };
    struct Query {
        Vec2d at;
        double thin;  // mm: pieces this thin are not halved
    };
    // The tool on a plane that ends: height of the tip, and where in plan it touches.
    struct PlaneContact {
        double height;
        Vec2d place;
    };
    struct Rectangle {
        double x0, x1, y0, y1;
    };
    enum class NextStep : std::uint8_t { kNone, kHalveMove, kHalvePiece };

    // The tree (drop_cutter_pieces.cpp).
    void gather(std::uint32_t place, std::uint32_t parent, Piece* first, Piece* last);
    std::uint32_t sibling(std::uint32_t piece) const
    {
        return 2 * pieces_[pieces_[piece].parent].child + 1 - piece;
    }
    void halve(std::uint32_t piece);
    void forget_many_halves();
    // Room for `more` elements. Doubled, vectors would hold as much again as the halves kept.
    template <class T>
    static void make_room(std::vector<T>& in, std::size_t more)
    {
        if (in.capacity() - in.size() < more) {
            in.reserve(in.size() + std::max(more, in.size() / 8));
        }
    }
    std::uint32_t add_outline(const Outline& outline)
    {
        make_room(outlines_, 1);
        outlines_.push_back(outline);
        return static_cast<std::uint32_t>(outlines_.size() - 1);
    }
    void measure(Piece& piece);
    void measure_plane(Piece& piece) const;
    void measure_wall(Piece& piece, Vec3d normal) const;
    // Control points of the piece being measured.
    const Vec3d* points_of(const Piece& piece) const
    {
        return patch_of(piece).weighted ? unweighted_.data() : &nets_[piece.net];
    }
    static double extent(const Piece& piece)
    {
        return std::max({piece.x1 - piece.x0, piece.y1 - piece.y0, piece.z1 - piece.z0});
    }
    // Distance of x from [low, high].
    static double excess(double low, double high, double x)
    {
        return std::max(0.0, std::max(low - x, x - high));
    }
    // False where the piece, or its outline, may extend more than `thin` beyond the surface.
    bool is_whole(const Piece& piece, double thin) const
    {
        const bool exact = piece.outline == 0 ? !piece.cut : outlines_[piece.outline].bow <= thin;
        return exact || extent(piece) < thin;
    }

    // Ends of pieces (drop_cutter_outline.cpp, drop_cutter_trim.cpp).
    void measure_outline(Piece& piece);
    bool set_sides(const Piece& piece, Outline& outline) const;
    static void widen(Side& side, Vec2d p);
    static void end_sides(Outline& outline);
    double beyond_outline(const Piece& piece, Vec2d at) const;
    std::optional<PlaneContact> on_outline(const Piece& piece, Vec2d at) const;
    Vec2d on_piece(const Piece& piece, Vec2d at) const;
    double apart_from_outline(const Piece& piece, Vec3d a, Vec3d b) const;
    double apart_from_plate(const Piece& piece, Vec3d a, Vec3d b) const;
    Domain domain_of(const Piece& piece) const;
    void trim(Piece& piece);
    void find_remnant(const Piece& piece);
    static std::optional<Side> side_along(const Remnant& left, double& bow);
    static Side side_of(const Remnant& left, Vec2d across);
    static double end_at_edge(const Remnant& left, Outline& outline);
    void measure_remnant(Piece& piece);

    // The drop (drop_cutter_query.cpp).
    static double over_plane(const Piece& piece, Vec2d at);
    static double square_off_wall(const Piece& wall, Vec2d at);
    double over_wall(const Piece& wall, Vec2d at) const;
    std::uint32_t guess(Vec2d at) const;
    double bound(const Piece& piece, const Query& query, double best, bool& tight) const;
    Vec2d slope_of(const Piece& piece, Vec2d at) const;
    double side_slope(double away) const;
    std::optional<PlaneContact> on_edges(const Piece& piece, Vec2d at) const;
    std::optional<PlaneContact> on_edges(
        const Rectangle& part, Vec2d slope, double here, double reach, Vec2d at) const;

    // The clearance of a move (drop_cutter_clearance.cpp).
    double beside_line(const Piece& piece, const Vec3d& a, const Vec3d& b) const;
    bool overhangs(const Piece& piece) const;
    double ball_clearance(const Piece& piece, const Vec3d& a, const Vec3d& b, double margin) const;
    double axial_clearance(const Piece& piece, Vec3d a, Vec3d b, double margin) const;
    NextStep next_step(const Piece& piece, double here, double length, double tilt) const;

    // The contact (drop_cutter_section.cpp).
    std::optional<CcPoint> cc_point_on(const Piece& piece, double height, double u, double v) const;

    // The lists of a cutter, for their room.
    struct Rooms {
        std::vector<Piece> pieces;
        std::vector<Vec3d> nets;
        std::vector<double> weights;
        std::vector<Outline> outlines;
    };
    // The part that queries do not change, shared by the cutters of several threads.
    struct Floor {
        std::vector<nurbs::Surface> surfaces;
        std::vector<part_model::TrimRegion> trims;  // of each surface; empty where none is trimmed
        std::vector<Patch> patches;
        // The pieces before any is halved.
        std::vector<Piece> pieces;
        std::vector<Vec3d> nets;
        std::vector<double> weights;
        std::vector<Outline> outlines;
        double lowest{kUnbounded};
        double highest{-kUnbounded};
        // Rooms of cutters that are gone.
        mutable std::mutex guard;
        mutable std::vector<Rooms> spare;
    };
    // Takes the rooms of a cutter that is gone, if there is one: pages that are given back to the
    // system and taken anew cost more than their content.
    void take_spare_rooms();
    const Patch& patch_of(const Piece& piece) const { return floor_->patches[piece.patch]; }
    void add_patches(Floor& floor, std::uint32_t s, std::vector<Piece>& whole);
    void begin_with_whole_pieces();
    std::size_t bytes_of_halves() const;

    toolpath::Tool tool_;
    double accuracy_;
    std::shared_ptr<const Floor> floor_;
    std::optional<part_model::EdgeGougeCheck> edges_;
    std::vector<Piece> pieces_;         // halved when first needed
    std::vector<Vec3d> nets_;           // control points; times their weights where those differ
    std::vector<double> weights_;       // parallel to nets_, up to the last patch with weights
    std::vector<Outline> outlines_{1};  // the first one means none
    // State of the piece being measured.
    std::vector<Vec3d> unweighted_;  // control points
    part_model::TrimRegion::Remnant in_domain_;
    Remnant remnant_;
    std::uint32_t last_{kRoot};    // the piece that the last drop rested on
    std::uint32_t beside_{kRoot};  // the smallest piece that the last move came near to
    std::size_t halvings_{0};
};

}  // namespace cusp::drop_cutter
