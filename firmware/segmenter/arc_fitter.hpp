// Fits arcs and lines to runs of short lines, within a tolerance: greedy, streaming, in fixed memory.
//
//   ArcFitter fitter{settings, buffer};
//   fitter.start(first);
//   for (Vec3d vertex : rest) {
//       while (!fitter.has_room() && fitter.next(move)) { ... }
//       fitter.push(vertex);
//   }
//   fitter.finish();
//   while (fitter.next(move)) { ... }  // move.is_arc, move.end, move.deviation
//
// An arc goes through the first and the last vertex that it replaces. The arcs through two points
// that keep a third within its band form an interval of the bulge tan(sweep / 4), and its ends are
// roots of a quadratic; so the arcs that keep all vertices are the intersection of intervals, found
// in one pass. The middles of the lines are bounded likewise, with a little more room. Every arc is
// verified as it will be written: centre rounded, vertices in order.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/path/path.hpp"

namespace cusp::segmenter {

struct FitSettings {
    // Distance allowed between a vertex and the new path on either side of it, mm, as seen along
    // the motion with the normal of the arc's plane upwards (of a line: Z).
    double left{0.01};
    double right{0.01};
    // Centre offsets are rounded to multiples of this, mm; 0 for none.
    double centre_step{1e-4};
    // No arc shorter than this, mm, or of a larger radius.
    double least_arc_length{0.02};
    double greatest_radius{10000};
    // No arc turns further, radians; at most 1.5 pi.
    double greatest_sweep{4.6};
    bool arcs{true};  // false: lines only
};

// A fitted move; it starts where the one before ended.
struct FittedMove {
    bool is_arc;
    Vec3d end;          // a vertex, unchanged
    path::Plane plane;  // of an arc
    bool clockwise;
    double first_offset;  // start to centre along the plane's axes (I J, K I, J K), mm
    double second_offset;
    std::uint32_t lines;  // how many lines it replaces, 1 or more
    double deviation;     // the largest distance of vertices and middles of lines from it, mm
};

// Vertices go in with push(), moves come out with next(). The longer the buffer, the longer the
// moves: a move replaces at most its size - 1 lines.
class ArcFitter {
public:
    // The buffer outlives the fitter. Precondition: at least 4 vertices.
    ArcFitter(const FitSettings& settings, Span<Vec3d> buffer) noexcept;

    // Starts a run at a point; forgets what was not taken.
    void start(Vec3d point) noexcept;

    // True where push() takes one more vertex; otherwise take moves with next() first.
    bool has_room() const noexcept { return end_ < buffer_.size(); }

    // The end of the next line of the run. Precondition: has_room(), start() was called.
    void push(Vec3d vertex) noexcept;

    // No further vertex belongs to the run: next() hands out all that is left.
    void finish() noexcept { finished_ = true; }

    // The next move: false where more vertices are needed first, or nothing is left.
    // Cost: O(n log n) in the lines that it replaces.
    bool next(FittedMove& move) noexcept;

private:
    bool fit(std::size_t count, FittedMove& move) const noexcept;
    std::size_t farthest(FittedMove& move) const noexcept;
    std::size_t waiting() const noexcept { return end_ - begin_ - 1; }

    FitSettings settings_;
    Span<Vec3d> buffer_;
    std::size_t begin_{0};
    std::size_t end_{0};
    bool finished_{false};
};

}  // namespace cusp::segmenter
