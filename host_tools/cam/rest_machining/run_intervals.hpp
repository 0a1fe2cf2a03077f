// The feed moves between two rapids, parametrised by length: intervals in stock, and their moves.
#pragma once

#include <vector>

#include "host_tools/cam/rest_machining/swept_stock.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::rest_machining {

// mm: between a curve and the chords that are looked at
inline constexpr double kChordError = 2e-4;

// An interval of a run's length, mm.
struct RunInterval {
    double begin;
    double end;
};

class FeedRun {
public:
    explicit FeedRun(Vec3d start) : start_{start} {}

    void add(const toolpath::ToolMove& move);

    bool empty() const { return moves_.empty(); }
    Vec3d start() const { return start_; }
    double length() const { return ends_.empty() ? 0.0 : ends_.back(); }

    // The intervals in which the tool meets stock, to an eighth of its radius. A NURBS counts as a whole.
    //
    // inner  the tool less the tolerance, and less kChordError
    std::vector<RunInterval> in_stock(const SweptStock& stock, const EndProfile& inner) const;

    // The interval, extended by `by` mm at both ends within the run. No end is inside a NURBS.
    RunInterval widened(const RunInterval& interval, double by) const;

    // s of the feed moves in the interval
    double seconds(const toolpath::Toolpath& path, const RunInterval& interval) const;

    Vec3d point_at(double length) const;

    // The moves of the interval; lines and arcs at its ends are cut there.
    std::vector<toolpath::ToolMove> moves_in(const RunInterval& interval) const;

private:
    Vec3d start_;
    std::vector<toolpath::ToolMove> moves_;
    std::vector<double> ends_;  // mm along the run

    double begin_of(std::size_t k) const { return k == 0 ? 0.0 : ends_[k - 1]; }
    Vec3d start_of(std::size_t k) const { return k == 0 ? start_ : end_of_move(k - 1); }
    Vec3d end_of_move(std::size_t k) const;
    std::size_t move_at(double length) const;
    toolpath::ToolMove piece(std::size_t k, double begin_share, double end_share) const;
};

}  // namespace cusp::rest_machining
