// Height of the stock in a pocket on a fine grid (a Z-map), for the depth of cut of moves.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/offset/contour.hpp"
#include "host_tools/toolpath/toolpath.hpp"

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

    // Removes the sweep of the tool on a straight move. Returns the deepest cut, mm.
    double cut(Vec3d from, Vec3d to) { return sweep(from, to, false); }

    // As cut(), with a tool reduced by slivers: stock that it would only graze stays, and counts
    // for the next move that meets it.
    double cut_with_shrunk_tool(Vec3d from, Vec3d to) { return sweep(from, to, true); }

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
    struct Lowered {
        std::size_t place;  // in heights_
        float before;
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
    double sweep(Vec3d from, Vec3d to, bool inside);
    void cut_at(const Position& position, double& deepest);
    void cut_column(std::size_t column, Range rows, const Position& position, double& deepest);
    Range maybe_lower(double x, Range rows, Vec3d tip) const;
    Range under_last(double x, Range rows, Vec3d tip) const;
};

}  // namespace cusp::clearing
