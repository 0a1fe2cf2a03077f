// Fits few moves to the CL heights of a path in plan, each proved free of gouges.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::grid_pocket {

struct FollowSettings {
    double tolerance{};       // mm, > 0: height of the band above the exact tip height
    bool both_sides{};        // the band extends as far below it: the paper's rule
    bool arcs{};              // G18 and G19 arcs on runs along an axis
    double arc_tolerance{};   // mm, > 0: the band's height for fitted arcs
    double max_arc_radius{};  // mm: flatter arcs become lines
    double sample{};          // mm, > 0: between sampled heights along a run
};

// Largest distance of a move from the exact height, mm.
double band_height(const FollowSettings& settings);

// mm: least radius of curvature assumed for the CL height over a smooth floor. For a ball this is
// proved. The rim of a flat end follows the floor itself, so there the proof of each move decides.
double bend_radius(const toolpath::Tool& tool);

class ClPathFitter {
public:
    // allowance  mm left over all of the floor, along the normal
    ClPathFitter(const std::vector<nurbs::Surface>& floor,
                 const toolpath::Tool& tool,
                 double allowance,
                 FollowSettings settings);

    // A fitter that stays at or above `level` (z): the floor of a roughing layer.
    ClPathFitter above(double level) const;

    // Exact height of the tip at (x, y); none if no surface lies below the tool.
    std::optional<double> height(Vec2d at) const;

    // Height at which moves pass the point: the exact height, or the middle of the band.
    double start_height(Vec2d at) const;

    // Lower limit of moves at the point.
    double lowest_height(Vec2d at) const;

    // The floor's lowest z: passes beyond the floor continue at that height.
    double lowest() const { return drop_cutter_->lowest(); }

    // Lower limit of all moves.
    double bottom() const { return std::max(min_z_, lowest() + allowance_ - allowed_gouge()); }

    // Cuts along the corners, straight in plan between them. Precondition: the tip is at the first.
    void follow(toolpath::ToolpathWriter& moves,
                const std::vector<Vec2d>& corners,
                toolpath::MoveKind kind);

    // Cuts along an arc in plan from the tip's position, if the floor is level along it and the arc
    // is proved clear. Returns whether it did.
    bool follow_level_arc(toolpath::ToolpathWriter& moves,
                          const offset::Edge& arc,
                          toolpath::MoveKind kind);

    // The moves of follow() as chords from `start`, along at most `length` mm.
    std::vector<Vec3d> chords(const std::vector<Vec2d>& corners, double length) const;

    // Lower bound, at most 0, of the clearance of a straight move if the tool may be up to `margin`
    // mm beside it; see DropCutter::move_clearance().
    double move_clearance(Vec3d a, Vec3d b, double margin = 0.0) const;

    // mm: largest possible depth of a gouge by any move so far; 0 if all are proved clear.
    double gouge_bound() const { return gouge_bound_; }

    // Includes the gouge bound of another fitter over this floor.
    void add_bound(double depth) { gouge_bound_ = std::max(gouge_bound_, depth); }

private:
    std::shared_ptr<const drop_cutter::DropCutter> drop_cutter_;  // tool grown by the allowance
    // For a two-sided tolerance: that tool, reduced by the allowed gouge.
    std::shared_ptr<const drop_cutter::DropCutter> gouge_cutter_;
    double accuracy_;  // mm: heights are at most this much too high, clearances too low
    double allowance_;
    FollowSettings settings_;
    double min_z_{-kUnbounded};
    double gouge_bound_{0};

    // Largest allowed gouge: 0, or the band where it extends below the floor.
    double allowed_gouge() const { return settings_.both_sides ? band_height(settings_) : 0.0; }
    // mm above an exact height: moves at least that high can be proved clear.
    double reserve() const;
    bool is_ball() const
    {
        return drop_cutter_->tool().corner_radius == drop_cutter_->tool().radius;
    }
    cl_path::PathFloor floor() const;
    double path_height(Vec2d at) const;

    // The moves along the corners from `start_z`.
    cl_path::ClPath lines(const std::vector<Vec2d>& corners, double start_z) const;
    void follow_in_lines(toolpath::ToolpathWriter& moves,
                         const std::vector<Vec2d>& corners,
                         toolpath::MoveKind kind);
    double bulged_clearance(Vec3d a, Vec3d b, double sagitta) const;
    bool in_band(Vec2d at, double z) const;
    double arc_clearance(Vec3d from, const toolpath::ArcTo& arc, double curvature) const;
    std::vector<Vec3d> arc_vertices(Vec2d a, Vec2d b) const;
    bool follow_with_arcs(toolpath::ToolpathWriter& moves,
                          Vec2d a,
                          Vec2d b,
                          toolpath::MoveKind kind);
};

}  // namespace cusp::grid_pocket
