// Gouge check for rims and creases of a model, where a two-sided tolerance lets a ball cut into
// faces.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_model {

// A ball that cuts into a face along its normal removes as much as its depth. If it cuts as deep
// into the edge of the face from the side, it removes more, measured square to the face: the depth
// times the ratio of the normals' z, without limit at a vertical edge.
//
// Edges are the borders of the surfaces' domains, knot lines where the tangent plane may jump, and
// the edges of trims. They are polylines with sides of a 50th of the radius.
class EdgeGougeCheck {
public:
    // radius   mm, of the ball
    // deepest  mm > 0: what it may remove from a face, square to the face
    EdgeGougeCheck(const std::vector<nurbs::Surface>& surfaces, double radius, double deepest);

    // The polyline of tips, moved off edges so far that no point within `band` (mm) of it removes
    // more than allowed. Points are inserted where it bends; unchanged where nothing has to move.
    std::vector<Vec3d> moved_clear(const std::vector<Vec3d>& tips, double band) const;

    // A tip, raised if necessary, so that no point within `band` of it removes more than allowed.
    struct RaisedTip {
        Vec3d tip;
        // If raised: the centre of a ball of the tool's radius that the tool's centre touches now
        // and may not enter. Exact but for edges of nearly vertical faces.
        std::optional<Vec3d> barrier;
    };
    RaisedTip raised_clear(Vec3d tip, double band) const;

    // True if a straight move of the tip removes nowhere more than allowed.
    bool clears(Vec3d from, Vec3d to) const;

    // The most (mm) that a straight move of the tip removes from a face at its edge, square to the
    // face; 0: nothing. margin (mm): how far beside the straight line the tool may be.
    double cut(Vec3d from, Vec3d to, double margin) const;

private:
    struct Piece {
        Vec3d from;
        Vec3d to;
        double normal_z;  // z of the face's normal, the larger of its ends
    };
    // Extra distance that the ball has to keep from a piece.
    struct EdgeViolation {
        double amount;    // mm; no violation where <= 0
        Vec3d direction;  // from the piece to the centre; horizontal where the centre is lower
        double distance;  // mm, along it
        double faster;    // mm: allowed depth per upward component of the unit direction
    };
    Vec3d moved_clear_of(Vec3d tip, double band) const;
    // Returns whether some point had to move.
    bool append_moved(Vec3d from, Vec3d to, double band, std::vector<Vec3d>& out) const;
    void add_borders(const nurbs::Surface& surface, const TrimRegion& trims);
    void add_edge(
        const nurbs::Surface& surface, const TrimRegion& trims, Vec2d from, Vec2d to, Vec2d aside);
    void add(const Piece& piece);
    template <class Visit>
    void visit_around(Vec3d centre, double around, const Visit& visit) const;
    std::optional<EdgeViolation> violation_at(const Piece& piece,
                                              Vec3d centre,
                                              double margin) const;
    double clear_height(const Piece& piece,
                        Vec3d centre,
                        EdgeViolation violation,
                        double margin) const;
    Vec3d missing_clearance(Vec3d centre, double margin) const;
    std::int64_t cell(double at) const;

    double radius_;
    double max_gouge_;
    double step_;          // mm: between the points of a move that are checked
    double edge_error_{};  // mm: between an edge and its pieces
    double longest_{};     // mm: half the longest piece
    std::vector<Piece> pieces_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace cusp::part_model
