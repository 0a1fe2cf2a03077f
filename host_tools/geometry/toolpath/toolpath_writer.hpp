// Writes the moves of one tool: rapids, entries into stock, cuts, links and retracts.
//
//     ToolpathWriter writer{path.moves, {5.0, EntryKind::kHelix, 3.0}};  // rapids at z = 5
//     const std::vector<Vec3d> run{{0, 0, -2}, {20, 0, -2}};
//     writer.approach({0, 0}, 1.0);                    // rapids over the run's start, to z = 1
//     writer.enter(run, 0.0, [](Vec2d, double) { return -2.0; });  // helix from 0 down to -2
//     writer.line(MoveKind::kCut, run.back());
//     writer.retract();                                // rapid up to z = 5
//
// All coordinates are of the tool's tip, in mm. The strategy passes the heights of floor and stock,
// and decides where passes start and how they are linked.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/entry_kind.hpp"
#include "host_tools/geometry/toolpath/entry_run.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// Least descent of a turn of a slope round a closed run, over the tool's radius. On a circle so
// narrow that the tool's middle cuts anyway, a gentler slope is only slower.
inline constexpr double kLeastTurn = 0.2;

// True if a slope goes round a closed run of this length in plan, mm, rather than there and back along it.
bool goes_round(double length, double tool_radius);

// Rapid moves go no nearer to stock, mm.
inline constexpr double kRapidClearance = 1.0;

struct EntrySettings {
    double clearance_z{};                // rapid moves run at this height
    EntryKind kind{EntryKind::kPlunge};  // kAuto: a helix, or a ramp where it has no room
    double tool_radius{};                // mm: helices have half of it
    double max_drop{kUnbounded};         // mm: of a helix's turn, or of a ramp's trip out and back
};

class ToolpathWriter {
public:
    // The least z that the tip may have all around a circle in plan; no value where the tool has no
    // room there.
    using HelixFloor = std::function<std::optional<double>(Vec2d centre, double radius)>;

    // moves  that are written to; outlive this
    ToolpathWriter(std::vector<ToolMove>& moves, const EntrySettings& settings)
        : moves_{moves}, settings_{settings}
    {
    }

    // Place of the tool; not known before the first move.
    Vec3d at() const { return at_; }
    bool started() const { return started_; }
    bool is_retracted() const { return at_.z >= settings_.clearance_z; }
    double clearance_z() const { return settings_.clearance_z; }
    double tool_radius() const { return settings_.tool_radius; }

    // A straight move; none where the tool is there.
    void line(MoveKind kind, Vec3d end);
    void arc(MoveKind kind, const ArcTo& arc) { add({kind, arc}); }
    // Any move, as it is.
    void add(const ToolMove& move);

    // Up to the clearance height, where the tool is below it.
    void retract();

    // After a retract, rapid moves to over the place and down to z, where that is below the
    // clearance height.
    void approach(Vec2d place, double z);

    // From over the start of a run down to it: straight where no stock is deeper than 0.05 mm, else
    // on a helix, a ramp along the run, or straight where neither has room.
    //
    //   run        the pass that follows, or its points; the tool is straight over its start. Round a closed run
    //              that is short beside the tool the slope is steeper: a tenth of the tool's diameter a turn
    //   stock_top  z: below it stock may begin
    void enter(const EntryRun& run, double stock_top, const HelixFloor& floor);
    void enter(const std::vector<Vec3d>& run, double stock_top, const HelixFloor& floor)
    {
        enter(run_along(run), stock_top, floor);
    }

    int retracts() const { return retracts_; }
    int helices() const { return helices_; }
    // Number of entries that plunge straight though a helix or a ramp was asked for.
    int steep_plunges() const { return steep_plunges_; }
    // Number of entries without room for the helix that was asked for.
    int narrow_entries() const { return narrow_entries_; }

private:
    std::vector<ToolMove>& moves_;
    EntrySettings settings_;
    Vec3d at_{};
    bool started_{false};
    int retracts_{0};
    int helices_{0};
    int steep_plunges_{0};
    int narrow_entries_{0};

    bool helix(Vec3d start, const HelixFloor& floor);
    void ramp(const EntryRun& run);
    void go_along(const EntryRun& run, double depth, double whole, double& gone);
};

}  // namespace cusp::toolpath
