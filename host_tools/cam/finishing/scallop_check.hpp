// Proof that passes of a ball leave no more than the scallop over surfaces, cell by cell, and the
// missing passes where they leave more.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/uncut_walls.hpp"
#include "host_tools/cam/finishing/visibility_from_above.hpp"
#include "host_tools/cam/finishing/work_in_shares.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::finishing {

// If the tool can touch the surface, the stock left is measured vertically and multiplied by the
// cosine of the slope; on steep walls along the normal. Elsewhere (valleys, concave edges) it is
// measured above the lowest position of the tool.
//
// Proof for a cell of the domain: the volume that one straight move removes is convex. If it holds
// all four corners raised by the scallop, it holds the whole raised cell, for a ball smaller by the
// cell's deviation from flat. Cells that no single move covers are halved. The smallest cells are
// covered if each corner is, with a share of the scallop reserved for the slope between.
//
// The deviation from flat is twice that by the second derivatives at the corners. Points that the
// tool cannot touch are checked a quarter of a stepover apart; nothing is proved between them.
//
// Vertical parts of surfaces, and those that hardly lean, are checked by `WallSide` as well, from both
// sides: where the side of a ball reaches them that rests on something.
//
// Not for use by two threads at once. Long searches run on several, each with a copy that shares the
// passes; which copy looks at which cell does not depend on the number of threads.
class ScallopCheck {
public:
    // scallop    mm: allowed height of uncut stock
    // path_off   mm: maximum distance between the path that is cut and the points given to add()
    // most_gaps  uncovered cells that are kept
    ScallopCheck(const std::vector<nurbs::Surface>& surfaces,
                 const GougeFreePathFitter& path_fitter,
                 double scallop,
                 double path_off,
                 std::size_t most_gaps = 1000000);

    // A pass that will be cut, by its tips.
    void add(const Points& tips);

    // Checks one surface. Uncovered cells are kept for add_missing_passes().
    void check(int surface);
    // Checks all surfaces.
    //
    // progress  called with about the share that is done
    void check_all(const std::function<void(double)>& progress);
    // Checks a rectangle of the surface's domain.
    void check(int surface, Vec2d low, Vec2d high);

    // True if a check ended early because of more uncovered cells than are kept.
    bool overflowed() const { return overflowed_; }

    // Adds passes over uncovered cells. Each is given to `cut`, which must add() the path it cuts.
    //
    // progress  called with about the share that is done
    void add_missing_passes(const std::function<void(const Points&)>& cut,
                            const std::function<void(double)>& progress);

    // Adds passes along the borders of one surface that are the open rim of a vertical wall. The
    // tolerance leaves a sliver on such a wall that no pass beside it removes. Trims get none.
    void add_rim_passes(int surface, const std::function<void(const Points&)>& cut);

    // A part of a surface's domain.
    struct Part {
        int surface;
        Vec2d low;
        Vec2d high;
    };
    // The stock left in uncovered cells, measured at their middles and corners. It may be higher
    // between these.
    struct Unproved {
        std::vector<Part> parts;  // where the tool can touch the surface
        double left{};            // mm: the highest there
        double blocked_left{};    // mm: the highest elsewhere, above what the tool can reach
    };
    Unproved unproved();

    // mm: the most stock left beside walls, where that is more than the scallop; else 0.
    double left_beside_walls();

    // mm of walls that neither passes nor claims are made for: see walls_over_nothing(). Known after
    // add_missing_passes() or left_beside_walls().
    double over_nothing() const { return over_nothing_; }

    // Cells still uncovered after add_missing_passes(), and walls.
    std::size_t uncovered() const { return uncovered_.size() + walls_.size(); }

    // The highest stock measured there above what the tool can reach, mm.
    double most_left() const { return most_left_; }

    // mm: the highest stock measured beside rims and creases above what the tool can reach. Passes
    // are moved off these edges so as not to gouge them from the side. Not included in other
    // figures; 0 for a one-sided tolerance.
    double left_beside_edges() const { return left_beside_edges_; }

    ScallopCheck(const ScallopCheck&) = delete;
    ScallopCheck& operator=(const ScallopCheck&) = delete;

private:
    static constexpr int kDeepestCheck = 40;  // halvings of a cell
    static constexpr int kOwnParts = 12;      // the first of these end a part of the shared queries
    static constexpr std::size_t kCellsOfDrop = 15;
    struct Place {
        double u;
        double v;
    };
    // A place where a pass is missing, and a tip of that pass.
    struct MissingPass {
        Place place;
        Vec3d tip;
    };
    struct Corner {
        int surface;
        double u;
        double v;
        nurbs::SurfacePoint point;
        Vec3d normal;
    };
    struct Cell {
        int surface;
        double u0, u1, v0, v1;
    };
    // Bounds from the derivatives and normals at the corners of a cell.
    struct CellShape {
        double long_u, long_v;  // mm: lengths along u and v
        double bow;             // mm: deviation from flat
        double turn;            // of the normal
        double least_z;         // of the normals
    };
    enum class Verdict : std::uint8_t { kCovered, kHalveU, kHalveV, kUncovered };
    // The finding for one cell.
    struct CellFinding {
        bool missing{};         // a pass is needed here
        bool moved_clear{};     // some tip was rejected because it would gouge an edge
        double left{};          // mm: over the reachable height, where a pass is missing
        double beside_edges{};  // mm
    };
    // Cells where passes may be missing, and what is known of each.
    struct OpenCells {
        std::vector<Cell> cells;
        std::vector<CellFinding> findings;
    };
    // The cells of one surface where passes are missing, by number, and the next to be looked at.
    struct OpenOnSurface {
        std::vector<std::size_t> cells;
        std::size_t next{0};
    };
    struct SharedVisibility {
        std::once_flag made;
        std::optional<VisibilityFromAbove> value;
    };

    // A copy for another thread: without cells, with the passes of this one.
    struct ForThread {};
    ScallopCheck(const ScallopCheck& other, ForThread tag);
    // Calls work(copy, k) for the number k of each cell, on several threads, neighbours with one copy.
    void share_out(const std::vector<Cell>& cells,
                   const std::function<void(ScallopCheck&, std::size_t)>& work,
                   const std::function<void(double)>& progress);
    ReachableHeight::Drops work_at(
        OpenShare& share, const std::function<void(ScallopCheck&, std::size_t)>& work) const;
    // About the time of a copy, in cells looked at: a drop takes as long as `kCellsOfDrop`.
    std::size_t effort() const { return kCellsOfDrop * places_.drops_made() + judged_; }
    std::vector<CellFinding> findings_of(const std::vector<Cell>& cells, bool measure);
    void cut_missing(OpenCells& open,
                     const std::function<void(const Points&)>& cut,
                     const std::function<void(double)>& progress);
    std::vector<Points> next_traces(std::map<int, OpenOnSurface>& by_surface, OpenCells& open);
    Points next_trace(OpenOnSurface& surface, OpenCells& open) const;
    std::vector<Cell> cells_changed(const OpenCells& open);
    void measure_left(std::vector<Cell>& beside_edges);
    void take_waiting();
    std::vector<Cell> cells_of(int surface, Vec2d low, Vec2d high) const;
    void divide(const Cell& cell, int depth, std::vector<Cell>& out) const;

    Corner corner(int surface, double u, double v) const;
    bool inside_trims(int surface, double u, double v) const;
    // at  its corners, as `corners_of` gives them
    void check_cell(const Cell& cell, const std::array<Corner, 4>& at, int depth);
    static CellShape shape_of(const Cell& cell, const std::array<Corner, 4>& at);
    Verdict judge(const Cell& cell, const std::array<Corner, 4>& at) const;
    bool is_covered(const Corner& at) const
    {
        return places_.is_covered(at.point.point, at.normal);
    }
    Verdict thinned(const Cell& cell,
                    const std::array<Corner, 4>& at,
                    double long_u,
                    double long_v) const;
    bool is_steep(const std::array<Corner, 4>& at) const;
    bool is_clear(const Corner& at) const;
    bool blocked(const Corner& at) const { return !is_covered(at) && !is_clear(at); }
    bool is_uncovered(const std::array<Corner, 4>& at) const;
    bool blocked_somewhere(const std::array<Corner, 4>& at) const;
    bool settled(const Cell& cell, const std::array<Corner, 4>& at, const Corner& middle) const;
    bool is_hidden(const Corner& at) const;
    bool lies_under_others(const Cell& cell, const std::array<Corner, 4>& at) const;
    bool lies_under_itself(const std::array<Corner, 4>& at, const Corner& middle) const;
    bool silhouette_above(const std::array<Corner, 4>& at) const;
    const VisibilityFromAbove& visibility() const;
    bool in_narrow_opening(int surface, const Place& middle, const Place& corner_place) const;
    std::optional<MissingPass> uncovered_point(const Cell& cell) const;
    // A tip that would cut the stock over a point down to the scallop; none where the point is
    // covered, or where the tool cannot touch it and `where_blocked` is false.
    std::optional<Vec3d> missing_tip(int surface, double u, double v, bool where_blocked) const;
    std::optional<Vec3d> lower_tip(const Corner& at) const;
    std::array<Place, 5> places_of(const Cell& cell) const;
    double scallop_over_reachable(const Corner& at, double resolution);
    std::array<Corner, 4> corners_of(const Cell& cell) const;
    Corner middle_of(const Cell& cell) const;
    static std::array<Cell, 2> halves_of(const Cell& cell, bool along_u);
    std::array<double, 2> sides_of(const Cell& cell) const;
    double most_left_in(const std::vector<Cell>& cells);
    void measure_beside_edges(const std::vector<Cell>& cells);
    std::optional<Vec3d> tip_over_rim(int surface, Vec2d place) const;
    void add_pass_over_rim(int surface,
                           Vec2d from,
                           Vec2d to,
                           const std::function<void(const Points&)>& cut);
    Points trace(int surface, const MissingPass& from, Vec2d way) const;
    Points longest_trace(const Cell& cell, const MissingPass& from) const;

    const std::vector<nurbs::Surface>& surfaces_;
    const GougeFreePathFitter& path_fitter_;
    double radius_;
    double scallop_;
    double path_off_;
    std::size_t max_uncovered_;
    ScallopAtPoint places_;
    std::vector<Points> waiting_;  // passes added before the first check
    bool has_checked_{};
    std::shared_ptr<SharedVisibility> visibility_{std::make_shared<SharedVisibility>()};
    // State of a copy that works.
    const part_model::PartModel::SharedQueries::Part* queries_{nullptr};
    mutable std::size_t judged_{};  // cells
    std::vector<Cell> uncovered_;
    UncutWalls walls_;
    double most_left_{};
    double left_beside_edges_{};
    double over_nothing_{};
    bool overflowed_{};
    mutable bool nearly_uncovered_{};  // some tip would remove nearly the scallop
    mutable double near_share_{1};     // share of the scallop that counts as nearly
    mutable bool moved_clear_{};       // some tip was rejected because it would gouge an edge
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
