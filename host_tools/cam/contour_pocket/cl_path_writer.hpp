// Writes CL paths over a floor: entries that follow an uneven floor, cuts and links.
//
// The entries of ToolpathWriter need a level circle, or a run that starts at depth; a curved floor
// seldom has one. Here a helix follows the floor on each side, and the slope runs along the whole
// pass.
// runs round the whole pass.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::contour_pocket {

// Above the start of a pass: the end of rapid moves, and the possible top of stock, z in mm.
struct EntryHeights {
    double rapid;
    double stock_top;

    void raise_over(const EntryHeights& other);
};

// For stock up to z, mm.
EntryHeights heights_over(double stock_top);

// Slope of ramps and helices: 4.6 degrees.
inline constexpr double kEntrySlope = 0.08;

// The path's moves, all of the given kind.
std::vector<toolpath::ToolMove> tool_moves(const cl_path::ClPath& path, toolpath::MoveKind kind);

class ClPathWriter {
public:
    // clearance  z at which rapid moves run, mm
    explicit ClPathWriter(double clearance) : writer_{moves_, {clearance}} {}
    ClPathWriter(const ClPathWriter&) = delete;
    ClPathWriter& operator=(const ClPathWriter&) = delete;

    // Descends to the start of a pass of lines and arcs. The tool repeats the pass on a gentle
    // slope until all of it is at depth. It goes there and back along the first part of an open or
    // short pass, and plunges with `plunge`. A tool that is already above the start begins from
    // there.
    //
    // least_turn  mm: round a narrow closed pass it descends at least that far a turn
    void enter_along(const cl_path::ClPath& path,
                     const EntryHeights& heights,
                     double least_turn,
                     bool plunge);

    // A helix around the start of a pass.
    struct Helix {
        Vec3d centre;   // the start
        double radius;  // mm
        bool whole;     // true: ends at the start itself; false: may end above it
        EntryHeights heights;
        bool arcs;  // over a level floor half turns, else chords
    };
    // The floor below a helix.
    struct HelixFloor {
        // The lowest z of the tip at a place.
        std::function<double(Vec2d)> lowest;
        // Clearance of a straight move, mm; negative if it would gouge.
        std::function<double(Vec3d, Vec3d)> clearance;
    };
    // Returns the z at its end.
    double enter_by_helix(const Helix& helix, const HelixFloor& floor);

    void cut(const cl_path::ClPath& pass) { follow(toolpath::MoveKind::kCut, pass); }
    void link(const cl_path::ClPath& path) { follow(toolpath::MoveKind::kLink, path); }
    void retract() { writer_.retract(); }

    Vec3d place() const { return writer_.at(); }

    // True if the tool is below the clearance height.
    bool is_down() const { return below_clearance() > 0.0; }
    double below_clearance() const
    {
        return writer_.started() ? writer_.clearance_z() - place().z : 0.0;
    }

    // True if the tool is below the clearance height, vertically above, at or below the place.
    bool is_over(Vec3d place) const;

    const std::vector<toolpath::ToolMove>& moves() const { return moves_; }
    std::vector<toolpath::ToolMove> take() { return std::move(moves_); }
    int retracts() const { return writer_.retracts(); }
    int points() const { return points_; }
    // Number of entries that had no room for a slope and plunged farther than a helix leaves.
    int steep_plunges() const { return steep_plunges_; }

private:
    void plunge(Vec3d end) { writer_.line(toolpath::MoveKind::kPlunge, end); }
    double begin_entry(Vec3d start, const EntryHeights& heights);
    void plunge_over(Vec3d end, const std::function<double(Vec3d, Vec3d)>& clearance);
    void plunge_along(const toolpath::RunPiece& piece, double z);
    void half_turns(Vec2d centre, double z, double most);
    void follow(toolpath::MoveKind kind, const cl_path::ClPath& path);

    std::vector<toolpath::ToolMove> moves_;
    toolpath::ToolpathWriter writer_;
    int points_{};
    int steep_plunges_{};
};

}  // namespace cusp::contour_pocket
