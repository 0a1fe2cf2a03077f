// BlockMaker: cuts a move into blocks, one at a time.
#pragma once

#include "firmware/path/move.hpp"
#include "firmware/planner/path_queue.hpp"

namespace cusp::planner {

// Blocks end at exact nanometres and together at the end of the move.
class BlockMaker {
public:
    // Starts on a move. A move of no length is done at once.
    void start(const path::Move& move, AxisFilter filter) noexcept;

    bool done() const noexcept { return next_ == count_; }

    // The next piece. A curve is kept in the queue. Precondition: !done(), queue.free_curves() > 0.
    // Returns false where the piece has no length: take the next.
    bool make(const path::Move& move, PathQueue& queue, Block& block) noexcept;

private:
    bool make_curve(const path::BezierPiece& piece, PathQueue& queue, Block& block) const noexcept;
    void make_arc(const path::Arc& arc, Block& block) const noexcept;

    AxisFilter filter_{};
    std::uint32_t next_{0};
    std::uint32_t count_{0};
    double length_{0};
    Position at_{};
};

}  // namespace cusp::planner
