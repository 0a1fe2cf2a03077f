// Rims and creases of a model, and the tool kept off them where a two-sided tolerance would let it
// cut in.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/trim_region.hpp"

namespace cusp::part_model {

// A ball that cuts into a face square to it takes off its depth. One that cuts as deep into the
// face's edge, coming from beside it, takes off more, square to the face: the depth times the
// ratio of the normals' heights, without limit for one that passes an upright edge.
//
// Edges are the borders of the surfaces' domains, lines of knots where the tangent plane may jump,
// and the edges of trims. They are polylines, as fine as a 50th of the radius.
class EdgeGougeCheck {
public:
    // radius   mm, of the ball
    // deepest  mm: what it may take off a face, square to the face; positive
    EdgeGougeCheck(const std::vector<nurbs::Surface>& surfaces, double radius, double deepest);

    // The polyline of tips, moved off edges so far that no place within `band` (mm) of it takes off
    // more, with places between where it has to bend; unchanged where nothing has to move.
    std::vector<Vec3d> moved_clear(const std::vector<Vec3d>& tips, double band) const;

    // A tip that was raised where it had to be so that no place within `band` of it takes off more.
    struct RaisedTip {
        Vec3d tip;
        // Middle of a ball of the tool's radius that the tool's middle may not enter, and touches
        // now; none where nothing had to be raised. Right but for edges of all but upright faces.
        std::optional<Vec3d> barrier;
    };
    RaisedTip raised_clear(Vec3d tip, double band) const;

    // Whether a straight move of the tip takes nowhere more off a face at its edge.
    bool clears(Vec3d from, Vec3d to) const;

    // The most (mm) that a straight move of the tip takes off a face at its edge, square to the
    // face; 0: nothing. margin (mm): how far beside the straight line the tool may really be.
    double cut(Vec3d from, Vec3d to, double margin) const;

private:
    struct Piece {
        Vec3d from;
        Vec3d to;
        double upright;  // z of the face's normal, the larger of its ends
    };
    // How much farther off a piece the ball has to be, to take off no more.
    struct EdgeViolation {
        double amount;    // mm; none where not positive
        Vec3d direction;  // from the piece to the centre, or level where that is lower
        double distance;  // mm, along it
        double faster;    // mm: how the depth allowed grows with the way's share upward
    };
    Vec3d moved_clear_of(Vec3d tip, double band) const;
    // Returns whether some place had to move.
    bool append_moved(Vec3d from, Vec3d to, double band, std::vector<Vec3d>& out) const;
    void add_borders(const nurbs::Surface& surface, const TrimRegion& trims);
    void add_edge(
        const nurbs::Surface& surface, const TrimRegion& trims, Vec2d from, Vec2d to, Vec2d aside);
    void add(const Piece& piece);
    template <class Look>
    void look_round(Vec3d centre, double around, const Look& look) const;
    std::optional<EdgeViolation> violation_at(const Piece& piece,
                                              Vec3d centre,
                                              double margin) const;
    double clear_height(const Piece& piece,
                        Vec3d centre,
                        EdgeViolation violation,
                        double margin) const;
    Vec3d missing_clearance(Vec3d centre, double margin) const;
    std::uint64_t key(std::int64_t i, std::int64_t j) const;
    std::int64_t cell(double at) const;

    double radius_;
    double max_gouge_;
    double step_;          // mm: between places of a move looked at
    double edge_error_{};  // mm: between an edge and its pieces
    double longest_{};     // mm, of half a piece
    std::vector<Piece> pieces_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace cusp::part_model
