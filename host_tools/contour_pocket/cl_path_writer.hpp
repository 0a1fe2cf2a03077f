// Writes CL paths over a floor: entries that follow an uneven floor, cuts and links.
//
// What ToolpathWriter's entries need, a level circle or a run whose beginning lies at depth, a
// floor seldom offers. Here a helix goes as low as the floor allows on each side, and the slope
// runs round the whole pass.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::contour_pocket {

// Over the start of a pass: where rapid moves end and where stock may begin, z in mm.
struct EntryHeights {
    double rapid;
    double stock_top;

    void raise_over(const EntryHeights& other);
};

// Over stock that reaches up to z, mm.
EntryHeights heights_over(double stock_top);

// Of slopes and helices: 4.6 degrees.
inline constexpr double kEntrySlope = 0.08;

// The path's moves, of one kind.
std::vector<toolpath::ToolMove> tool_moves(const ClPath& path, toolpath::MoveKind kind);

class ClPathWriter {
public:
    // clearance  z at which rapid moves run, mm
    explicit ClPathWriter(double clearance) : writer_{moves_, {clearance}} {}
    ClPathWriter(const ClPathWriter&) = delete;
    ClPathWriter& operator=(const ClPathWriter&) = delete;

    // Down to the start of a pass of straight moves: round it again and again on a gentle slope
    // until it lies wholly at its depth, to and fro along the beginning of an open one or where
    // that is shorter; straight down where `plunge`. From where the tool is, where that is over the
    // start.
    void enter_along(const ClPath& path, const EntryHeights& heights, bool plunge);

    // A helix about the start of a pass.
    struct Helix {
        Vec3d centre;   // the start
        double radius;  // mm
        bool whole;     // down to the start itself; else to somewhere over it, mostly
        EntryHeights heights;
    };
    // The floor that a helix follows.
    struct HelixFloor {
        // The lowest z that the tip may have over a place.
        std::function<double(Vec2d)> lowest;
        // The gap under a straight move, mm; negative where it would gouge.
        std::function<double(Vec3d, Vec3d)> clearance;
    };
    // Returns the z it ends at.
    double enter_by_helix(const Helix& helix, const HelixFloor& floor);

    void cut(const ClPath& pass) { follow(toolpath::MoveKind::kCut, pass); }
    void link(const ClPath& path) { follow(toolpath::MoveKind::kLink, path); }
    void retract() { writer_.retract(); }

    Vec3d place() const { return writer_.at(); }

    // Whether the tool is somewhere below the clearance height, and how far.
    bool is_down() const { return below_clearance() > 0.0; }
    double below_clearance() const
    {
        return writer_.started() ? writer_.clearance_z() - place().z : 0.0;
    }

    // Whether the tool is straight over the place, on it or under it, below the clearance height.
    bool is_over(Vec3d place) const;

    const std::vector<toolpath::ToolMove>& moves() const { return moves_; }
    std::vector<toolpath::ToolMove> take() { return std::move(moves_); }
    int retracts() const { return writer_.retracts(); }
    int points() const { return points_; }
    // Entries that had no room for a slope and went down by more than a helix leaves.
    int steep_plunges() const { return steep_plunges_; }

private:
    void plunge(Vec3d end) { writer_.line(toolpath::MoveKind::kPlunge, end); }
    double begin_entry(Vec3d start, const EntryHeights& heights);
    void plunge_over(Vec3d end, const std::function<double(Vec3d, Vec3d)>& clearance);
    void follow(toolpath::MoveKind kind, const ClPath& path);

    std::vector<toolpath::ToolMove> moves_;
    toolpath::ToolpathWriter writer_;
    int points_{};
    int steep_plunges_{};
};

}  // namespace cusp::contour_pocket
