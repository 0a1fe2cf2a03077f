// Places of a mesh under the passes of any end: what is left over them, and the tip that would remove it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/mesh_traces.hpp"
#include "host_tools/cam/finishing/swept_tool.hpp"

namespace cusp::finishing {

// Queries change nothing: several threads may ask at once while none adds.
class MeshGround {
public:
    // path_fitter  of passes over a mesh
    // scallop      mm: allowed height of uncut stock
    // path_off     mm: maximum distance between the path that is cut and the points given to add()
    MeshGround(const GougeFreePathFitter& path_fitter, double scallop, double path_off);

    void add(const Points& tips) { swept_.add(tips); }

    const GougeFreePathFitter& path_fitter() const { return path_fitter_; }
    const SweptTool& swept() const { return swept_; }
    double scallop() const { return scallop_; }
    // mm: between passes on level ground, where an end is flat as wide as its radius.
    double step() const { return step_; }

    // The places of tips that touch ground of one normal.
    struct Side {
        Vec3d normal;
        ToolWindow window;
        bool upright;  // a vertical wall, but for rounding
        double fine;   // mm: what one move leaves low enough, the shorter way
    };
    Side side(Vec3d normal) const;

    // True if a move removes the stock over the place down to a share of the scallop.
    bool is_covered(const Side& side, Vec3d point, double share) const;
    bool is_covered(const MeshPlace& place, double share) const
    {
        return is_covered(side(place.normal), place.point, share);
    }
    // True if one move does over a whole triangle: what it removes is convex.
    //
    // last  number of a move that is tried first; set to the one found
    bool is_covered(const Side& side,
                    const std::array<Vec3d, 3>& corners,
                    std::uint32_t& last) const;

    // The part of the mesh that keeps the tool from a triangle which one place of its end would touch.
    part_model::PartModel::Blocked blocked(const Side& side,
                                           const std::array<Vec3d, 3>& corners) const;

    // The tip of a tool that touches the place and is clear of all others; none where there is none. A
    // flat end is tried at its middle and round its rim.
    std::optional<Vec3d> touching_tip(const Side& side, Vec3d point) const;

    // True if the mesh lies over the place.
    bool is_hidden(const MeshPlace& place) const;

    // True if the tool has a part of the mesh below it, other than a wall that it touches.
    bool rests(Vec3d tip) const;

    // touching_tip() of a place in the area that is not cut down to the scallop.
    std::optional<Vec3d> missing_tip(const MeshPlace& place) const;

    // mm: of stock over a place, along the shortest way to what is removed; at most the radius.
    //
    // enough  mm: less may be returned as something up to this
    double left(Vec3d point, double enough = 0) const;
    // True if that is more than a share of the scallop.
    bool is_left(Vec3d point, double share) const;

    // True if a tip would remove more than a share of the scallop, measured as left(), straight over a
    // place that is below it.
    bool gets_lower(Vec3d tip, Vec3d place, double share) const;

    // A tip that gets low over a place: the best of some round it, and of ever nearer ones round that.
    std::optional<Vec3d> low_tip_round(Vec3d place) const;

private:
    Vec3d lifted(const Side& side, Vec3d point, double height) const;
    Vec3d tip_of(Vec3d end) const { return end - Vec3d{0, 0, swept_.profile().corner()}; }
    double slack() const;

    const GougeFreePathFitter& path_fitter_;
    double scallop_;
    double path_off_;
    SweptTool swept_;
    double step_;
    double height_;  // mm, of the mesh
    std::vector<Vec3d>
        level_off_;  // mm: ends of a flat tool that touch a level place, over the place
};

}  // namespace cusp::finishing
