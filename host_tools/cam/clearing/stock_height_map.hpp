// Height of the stock in a pocket on a fine grid (a Z-map), for the depth of cut of moves.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::clearing {

// Heights of the stock at points of a grid (a coarser one in pockets of over four million points).
// Thinner stock may be missed.
class StockHeightMap {
public:
    // box    everything that the tool may touch
    // top    z of the uncut stock
    // share  of the tool's radius: pitch of the grid
    StockHeightMap(const offset::Box2d& box,
                   const toolpath::Tool& tool,
                   double top,
                   double share = 1.0 / 12);

    // Changes the tool.
    void set_tool(const toolpath::Tool& tool);

    // z at which a tip descending at `at` first touches stock, with the part of the tool within
    // that share of its radius; -kUnbounded, no bound, where there is none.
    double contact_height(Vec2d at, double share = 1.0) const;

    // At least contact_height() at each place that is no farther from `at` than `within` (mm).
    double most_contact_height(Vec2d at, double within) const;

    // A straight move.
    struct Move {
        Vec3d from;
        Vec3d to;
    };
    // Removes the sweep of the tool on a move. Returns the deepest cut, mm.
    double cut(Vec3d from, Vec3d to) { return cut({{from, to}}).front(); }

    // As cut() of one move after the other, on several threads where they are long; the deepest cut of
    // each. Results do not depend on the number of threads.
    std::vector<double> cut(const std::vector<Move>& moves) { return sweep(moves, false); }

    // As cut(), with a tool reduced by slivers: stock that it would only graze stays, and counts
    // for the next move that meets it.
    std::vector<double> cut_with_shrunk_tool(const std::vector<Move>& moves)
    {
        return sweep(moves, true);
    }

    // Cuts between the two are trials: end_trial() takes them back. One trial at a time, by one tool.
    void begin_trial();
    void end_trial();

private:
    // The tool's lower side: a flat of radius `flat`, a corner around it.
    struct Profile {
        double flat;
        double corner;
        double reach;  // squared radius of the whole tool
        double at(double squared) const;
    };
    struct Axis {
        double origin;
        double pitch;
        std::size_t count;
    };
    struct Range {
        std::size_t begin;
        std::size_t end;
    };
    struct Position {
        Vec3d tip;
        bool shrunk;  // of cut_with_shrunk_tool()
    };
    // A position of a move, by the move's number.
    struct Sample {
        Position position;
        std::size_t move;
        Range columns;  // under the tool
    };
    struct Lowered {
        std::size_t place;  // in heights_
        float before;
    };
    // The cuts in some columns.
    struct Cuts {
        Range columns;
        std::vector<double> deepest;  // of each move
        std::vector<Lowered> lowered{};
    };

    double spacing_{};
    double sliver_{};  // mm: slivers between two positions of a move are ignored
    Profile tool_{};
    Profile probe_profile_{};  // the tool reduced by the slivers
    // Lower bounds of the tool's lower side by squared distance: most points under it are already
    // cut and need no square root.
    std::array<double, 257> at_least_{};
    Vec2d origin_;
    double pitch_;
    std::size_t columns_;
    std::size_t rows_;
    double top_;
    std::vector<float> heights_;
    std::optional<Position> last_;  // the points under it are already cut
    bool on_trial_{};
    std::vector<Lowered> lowered_;  // in the trial, in order
    std::optional<Position> last_before_trial_;

    Axis column_axis() const { return {origin_.x, pitch_, columns_}; }
    Axis row_axis() const { return {origin_.y, pitch_, rows_}; }
    static Range range(double low, double high, const Axis& axis);
    const Profile& profile_of(const Position& position) const
    {
        return position.shrunk ? probe_profile_ : tool_;
    }
    template <class LowerSide>
    double highest_over(Vec2d at, double reach, const LowerSide& lower_side) const;
    std::vector<double> sweep(const std::vector<Move>& moves, bool shrunk);
    std::vector<Sample> samples_of(const std::vector<Move>& moves, bool shrunk) const;
    void cut_samples(const std::vector<Sample>& samples, Cuts& cuts);
    void cut_at(const Sample& sample, const std::optional<Position>& last, Cuts& cuts);
    void cut_column(
        std::size_t column, Range rows, const Position& position, double& deepest, Cuts& cuts);
    Range maybe_lower(double x, Range rows, Vec3d tip, Vec3d last) const;
    Range under_last(double x, Range rows, Vec3d tip, const Position& last) const;
};

}  // namespace cusp::clearing
