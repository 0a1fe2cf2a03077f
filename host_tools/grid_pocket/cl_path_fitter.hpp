// Fits moves to the CL heights of a path in plan: few moves, each proven not to gouge.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/grid_pocket/profile_fit.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/offset/contour.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::grid_pocket {

struct FollowSettings {
    double tolerance{};       // mm, > 0: height of the band over the exact tip height
    bool both_sides{};        // the band reaches as far below it: the paper's rule
    bool arcs{};              // G18 and G19 arcs on runs along an axis
    double arc_tolerance{};   // mm, > 0: the band's height where arcs are fitted
    double max_arc_radius{};  // mm: flatter arcs become lines
    double sample{};          // mm, > 0: between heights along a run
};

// How far a move may be from the exact height, mm.
double band_height(const FollowSettings& settings);

// The CL height over a smooth floor is assumed to bend no tighter than with this radius, mm. For a
// ball that is proven. The rim of a flat end follows the floor itself: there the proof of each move
// decides.
double bend_radius(const toolpath::Tool& tool);

class ClPathFitter {
public:
    // Heights leave `allowance` mm, square to the surface, all over the floor.
    ClPathFitter(const std::vector<nurbs::Surface>& floor,
                 const toolpath::Tool& tool,
                 double allowance,
                 FollowSettings settings);

    // A fitter that stays at `level` (z) or above: the floor of a roughing layer.
    ClPathFitter above(double level) const;

    // Exact height of the tip over (x, y); none where no surface lies under the tool.
    std::optional<double> height(Vec2d at) const;

    // Height at which moves pass the point: the exact one, or the middle of the band.
    double start_height(Vec2d at) const;

    // The lowest that moves over the point may be.
    double lowest_height(Vec2d at) const;

    // The floor's lowest z: where it ends, passes go on at that height.
    double lowest() const { return drop_cutter_->lowest(); }

    // No move is lower than this.
    double bottom() const { return std::max(min_z_, lowest() + allowance_ - allowed_gouge()); }

    // Cuts along the corners, straight in plan between them; the tip is at the first.
    void follow(toolpath::ToolpathWriter& moves,
                const std::vector<Vec2d>& corners,
                toolpath::MoveKind kind);

    // Cuts along an arc in plan, with the tip at its start, where the floor is level along it and
    // the arc is proven clear. Returns whether it did.
    bool follow_level_arc(toolpath::ToolpathWriter& moves,
                          const offset::Edge& arc,
                          toolpath::MoveKind kind);

    // follow() as chords from `start`, along at most `length` mm.
    std::vector<Vec3d> chords(const std::vector<Vec2d>& corners, double length) const;

    // Lower bound, at most 0, of the gap under a straight move whose tool may be `margin` mm beside
    // it; see DropCutter::move_clearance().
    double move_clearance(Vec3d a, Vec3d b, double margin = 0.0) const;

    // Largest depth that any move so far may cut into the floor; 0 where all are proven clear.
    double gouge_bound() const { return gouge_bound_; }

    // Includes the gouge bound of another fitter over this floor.
    void add_bound(double depth) { gouge_bound_ = std::max(gouge_bound_, depth); }

private:
    std::shared_ptr<const drop_cutter::DropCutter> drop_cutter_;  // tool grown by the allowance
    // Of a two-sided tolerance: that tool, smaller by the gouge allowed.
    std::shared_ptr<const drop_cutter::DropCutter> gouge_cutter_;
    double accuracy_;  // mm: drops are at most this much too high, clearances too low
    double allowance_;
    FollowSettings settings_;
    double min_z_{-kUnbounded};
    double gouge_bound_{0};

    // How deep a move may cut: nothing, or the band where it reaches below the floor.
    double allowed_gouge() const { return settings_.both_sides ? band_height(settings_) : 0.0; }
    // mm over an exact height: moves no lower than that can be proven not to gouge.
    double reserve() const;
    bool is_ball() const
    {
        return drop_cutter_->tool().corner_radius == drop_cutter_->tool().radius;
    }
    // mm: the part of a two-sided tolerance that bands take.
    double used_of(double tolerance) const;
    double path_height(Vec2d at) const;

    std::vector<BandPoint> band(Vec2d a, Vec2d b, double tolerance) const;
    bool raise_band(std::vector<BandPoint>& places,
                    const std::vector<ProfilePoint>& points,
                    const std::function<Vec3d(const ProfilePoint&)>& point) const;
    void follow_segment(toolpath::ToolpathWriter& moves, Vec2d a, Vec2d b, toolpath::MoveKind kind);
    double bulged_clearance(Vec3d a, Vec3d b, double sagitta) const;
    bool in_band(Vec2d at, double z) const;
    double arc_clearance(Vec3d from, const toolpath::ArcTo& arc, double curvature) const;
    std::vector<Vec3d> arc_vertices(Vec2d a, Vec2d b) const;
    bool follow_with_arcs(toolpath::ToolpathWriter& moves,
                          Vec2d a,
                          Vec2d b,
                          toolpath::MoveKind kind);
    void chord(toolpath::ToolpathWriter& moves, Vec3d end, toolpath::MoveKind kind, int depth);
};

}  // namespace cusp::grid_pocket
