// The lowest position of a tool over a point that it cannot touch: in valleys, at concave edges and
// under overhangs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host_tools/geometry/drop_cutter/approach_block.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::drop_cutter {

// The search starts from drops of the tool on a grid, computed when first needed. It minimizes the
// height over all contacts found so far, drops the tool at the minimum, which adds a contact, and
// repeats until drop and contacts agree (Kelley's cutting-plane method). For a ball the search also
// covers all directions of approach by what contacts block (`HalfSphereCover`), or finds a lower
// position.
//
// Not a proof: the search ends after some dozen caps, contacts are those of drops, which may be a
// little high, and for other tools a lower position may lie between points of the grid. Beside a rim
// answers for a ball are within 0.002 mm (tests/unit/finishing/reachable_height_test.cpp).
//
// Not for use by two threads at once.
class LowestPositionSearch {
public:
    // A dropped tool and its contact.
    struct DroppedTool {
        Vec3d centre;  // corner radius above the tip: the centre of a ball; z is kInfinite where
                       // the tool touches nothing, or where it is not allowed
        Vec3d contact;
    };
    using Drop = std::function<DroppedTool(double x, double y)>;
    // Drops at nodes of the grid, by node.
    using Nodes = std::unordered_map<std::uint64_t, DroppedTool>;

    // tool      that cuts
    // growth    mm: how much the tool of `drop` is larger all round
    // pitch     mm, of the grid
    // agrees    mm: a search ends where drop and contacts differ by less; greater than the error of
    //           drops
    LowestPositionSearch(
        const toolpath::Tool& tool, double growth, double pitch, double agrees, Drop drop);

    struct Position {
        Vec3d centre;
        double height;  // z, mm: how low the tool cuts straight above or below the point
    };
    // The lowest position over the point; none where the tool has no position over it.
    //
    // exact_below  mm: heights above this may be inexact; a low one saves most of the time
    // sufficient   mm: the search ends at heights below this
    // guess        in plan: where a low position is expected
    std::optional<Position> lowest_over(Vec3d place,
                                        double exact_below,
                                        double sufficient = -kUnbounded,
                                        std::optional<Vec2d> guess = std::nullopt);

    // The lowest positions of the grid over the point, at most three, apart from each other.
    std::vector<Position> starts_over(Vec3d place);

    DroppedTool drop_at(double x, double y) const { return drop_(x, y); }

    // Height at which the tool with this centre cuts over the point: z, mm; kInfinite if it misses
    // it.
    double height_under(Vec3d centre, Vec3d place) const;
    double pitch() const { return pitch_; }

    // Drops of other searches with the same grid and tool, which this one does not make again. They
    // must live, and not change, while this one searches.
    void use(const Nodes* known) { known_ = known; }
    // Seeds the cache with drops made elsewhere. To be called before it searches.
    void begin_with(Nodes nodes);
    const Nodes& nodes() const { return nodes_; }
    // The drops made since the last call; not those that it began with.
    Nodes take_nodes();

private:
    std::int64_t cell(double at) const;
    const DroppedTool& node(std::int64_t i, std::int64_t j);
    double lowest_known(Vec3d place, Vec2d at) const;
    Vec2d improved(Vec3d place, Vec2d at);
    void improve_from(const Position& start,
                      Vec3d place,
                      double exact_below,
                      std::optional<Position>& best);

    void improve_by_drops(Vec3d place, Position& best);
    // proved  set to true where none is found and none exists
    std::optional<Position> lower_than(double height, Vec3d place, bool& proved);
    ApproachBlock greatest_block(Vec3d point, Vec3d centre) const;
    std::optional<Position> lower_at(Vec2d at, Vec3d point, Vec3d centre, ApproachBlock& best);

    double radius_;
    double flat_;            // mm: radius of the tool's flat
    double corner_;          // mm: the tool's corner radius
    double contact_corner_;  // mm: of the tool that is dropped
    double pitch_;
    double agreement_;
    Drop drop_;
    const Nodes* known_{nullptr};
    Nodes nodes_;
    std::vector<std::uint64_t> begun_with_;
    std::vector<Vec3d> contacts_;  // near the point of the query
    // The contacts of the last proof in each square of the grid: usually they block the next point nearby.
    std::unordered_map<std::uint64_t, std::vector<Vec3d>> proofs_;
};

// Drops the cutter's tool. The contact is on the tool, above the surface by up to the accuracy of
// the drop.
LowestPositionSearch::DroppedTool drop_tool(const DropCutter& floor, double x, double y);

}  // namespace cusp::drop_cutter
