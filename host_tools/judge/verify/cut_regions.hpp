// The regions in which each operation of a job with 2.5-D operations may cut, and how deep, from
// the job alone.
//
//     const std::vector<CutRegion> regions = cut_regions(job, grid);
//     const RegionAt here = regions.front().at(x, y, k);  // k: the point's place in the grid
//     here.inside;  // mm inside the region; < 0: so far beyond its wall
//     here.floor;   // z; nothing is cut below it
//
// Distances are those from chords of the drawing's curves, by brute force in buckets: no offset
// kernel, no planner.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/finished_ground.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/line_side.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

struct RegionAt {
    double inside;
    double floor;
    double left{0};  // mm: what the operation may leave over the floor
    // mm along z, on flanks: how far a path within its plan tolerance may leave them below and above the floor.
    double below{0};
    double above{0};
};

class CutRegion {
public:
    // grid  of the heights of surfaces, where the operation has some
    CutRegion(const job::Operation& operation, const HeightGrid& grid);

    // k  the point's place in the grid
    RegionAt at(double x, double y, std::size_t k) const;

    // Likewise at any place: where floors are known at points of the grid alone, the lowest around it.
    RegionAt around(Vec2d place) const;

    // mm: how far the tool's centre may go into the region, on the side that it has to clear; the
    // walls alone decide.
    double room(double x, double y) const;

    const job::Operation& operation() const { return *operation_; }

    // True of a finish that stays with its ground: around() is inside over it and beside it.
    bool is_ground() const { return ground_.has_value(); }

    // The loop of a profile that is nearest.
    std::size_t nearest_loop(double x, double y) const;

private:
    // mm from the loops, positive in the material that they bound.
    double into_material(double x, double y) const;
    double beside_edges(double x, double y) const;
    double from_curves(double x, double y) const;
    // mm from the line that is nearest, on the side that is cut; nothing beyond its ends. Far away: from it.
    std::optional<double> beside_lines(double x, double y) const;
    RegionAt profile_at(double x, double y) const;
    RegionAt ring_at(double x, double y) const;
    RegionAt hole_at(double x, double y) const;
    RegionAt beside_edge_at(double x, double y) const;
    RegionAt carved_at(double x, double y) const;
    RegionAt engraved_at(double x, double y) const;

    const job::Operation* operation_;
    HeightGrid grid_;
    double cap_;
    std::vector<WallDistance> walls_;
    std::vector<LineSide> lines_;  // of a profile beside lines: their walls, in the same order
    std::optional<FinishedGround> ground_;  // of a finish
    std::vector<double> heights_;           // of surfaces; NaN where there is none
};

// Chords of a chain within `chord` mm; job::loop_polyline() closes what it is given.
std::vector<Vec2d> open_polyline(const job::Chain& chain, double chord);

std::vector<CutRegion> cut_regions(const job::Job& job, const HeightGrid& grid);

// The box of what the job's loops, curves and holes reach with their tools; no value without any.
struct PlanBox {
    Vec2d low;
    Vec2d high;
};
std::optional<PlanBox> prismatic_box(const job::Job& job);

}  // namespace cusp::verify
