// How low a tool gets over a place that it can't touch: the best position of the tool in valleys,
// concave edges and under overhangs.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/drop_cutter/approach_directions.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/toolpath/tool.hpp"

namespace cusp::drop_cutter {

// Drops of the tool on a grid, made where first asked for, say where to begin. From there the
// position is improved over all contacts found so far, which are the floor that the tool stands on,
// dropped, and so on until drop and contacts agree (Kelley's way). For a ball all directions from
// which it may get lower are looked at, too: those that a contact bars are out
// (`ApproachDirections`), the others are divided until all are, or something better is found.
//
// Not quite a proof: the division ends after some hundred parts, and for other tools a better
// position may hide between the places of the grid.
class LowestPositionSearch {
public:
    // Where a dropped tool touches.
    struct DroppedTool {
        Vec3d centre;  // straight over the tip by the tool's corner radius, a ball's middle; z is
                       // kNowhere where the tool meets nothing, or may not stand
        Vec3d contact;
    };
    static constexpr double kNowhere = std::numeric_limits<double>::infinity();
    using Drop = std::function<DroppedTool(double x, double y)>;

    // tool      that cuts
    // growth    mm: how much larger all round the tool of `drop` is
    // pitch     mm, of the grid
    // agrees    mm: a search ends where drop and contacts differ by less; more than drops are high
    LowestPositionSearch(
        const toolpath::Tool& tool, double growth, double pitch, double agrees, Drop drop);

    struct Position {
        Vec3d centre;
        double height;  // mm: what the tool leaves straight above or below the place
    };
    // resolution  mm: heights above this may be inexact; a low one saves most of the time
    // enough mm: the search ends at heights below this
    // guess  in plan: where the tool may get low
    //
    // None where the tool can't stand over the place.
    std::optional<Position> lowest_over(Vec3d place,
                                        double resolution,
                                        double sufficient = -1e300,
                                        std::optional<Vec2d> guess = std::nullopt);

    // Places of the grid where the tool gets lowest, apart from each other.
    std::vector<Position> starts_over(Vec3d place);

    DroppedTool drop_at(double x, double y) const { return drop_(x, y); }

    // What the tool leaves over the place where its centre is there; infinite where it misses it.
    double height_under(Vec3d centre, Vec3d place) const;
    double pitch() const { return pitch_; }

private:
    // That no ball gets lower over a place: parts of all directions, and the contacts that bar
    // them.
    struct BlockedPart {
        ApproachDirections::Triangle triangle;
        std::size_t contact;
    };
    struct Proof {
        std::vector<Vec3d> contacts;
        std::vector<BlockedPart> parts;
    };

    std::int64_t cell(double at) const;
    static std::uint64_t key_of(int halvings, std::int64_t i, std::int64_t j);
    const DroppedTool& node(int halvings, std::int64_t i, std::int64_t j);
    const DroppedTool& node_near(double x, double y, double length);
    double lowest_known(Vec3d place, Vec2d at) const;
    Vec2d improved(Vec3d place, Vec2d at);
    void improve_from(const Position& start,
                      Vec3d place,
                      double resolution,
                      std::optional<Position>& best);

    void improve_by_drops(Vec3d place, Position& best);
    // proved  set to whether none is found because there is none
    std::optional<Position> lower_than(double height, Vec3d place, bool& proved);
    std::optional<Position> divided(double height, Vec3d place, bool exact, bool& proved);
    static Proof proof_of(std::vector<BlockedPart> barred, const ApproachDirections& directions);
    void store(Vec3d place, Proof proof);

    double radius_;
    double flat_;            // mm: radius of the tool's flat
    double corner_;          // mm: the tool's corner radius
    double contact_corner_;  // mm: of the tool that is dropped
    double pitch_;
    double agreement_;
    Drop drop_;
    std::unordered_map<std::uint64_t, DroppedTool> nodes_;
    std::vector<Vec3d> contacts_;                      // near the place asked for
    std::unordered_map<std::uint64_t, Proof> proofs_;  // by square of the grid: the last one
    std::size_t parts_{};                              // of all proofs
};

// The floor's tool dropped on it. The contact is where the tool is stopped, as far above the
// surface as the floor's accuracy.
LowestPositionSearch::DroppedTool drop_tool(const DropCutter& floor, double x, double y);

}  // namespace cusp::drop_cutter
