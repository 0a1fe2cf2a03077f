// The volume that straight moves of a ball remove, and the moves near a point.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::finishing {

// Moves are those of the ball's centre. The volume removed by one, a ball and its shank swept along
// a line, is convex.
//
// Not for use by two threads at once.
class SweptVolume {
public:
    struct Move {
        Vec3d from;
        Vec3d to;
        double length;  // mm, in plan
    };

    // radius  mm, of the ball
    // reach   mm: how far near() searches around a centre
    SweptVolume(double radius, double reach);

    // Adds straight moves through tips of the tool.
    void add(const std::vector<Vec3d>& tips);
    // Number of moves added.
    std::size_t moves() const { return moves_.size(); }

    // The numbers of all moves that pass within `reach` of the centre, and of some others, in order.
    void near(Vec3d centre, std::vector<std::uint32_t>& out) const;

    // As near(), and all moves below the centre, whose shank may pass it.
    void near_or_below(Vec3d centre, std::vector<std::uint32_t>& out) const;

    // True if the move removes the point, with a tool smaller by `shrink` (mm).
    bool removes(std::uint32_t move, Vec3d point, double shrink) const;

    // True if the ball, without its shank, reaches the point.
    bool passes_near(std::uint32_t move, Vec3d point) const;

    // The top of the stock at (x, y) after all moves, and the centre of the ball that cut it;
    // height is kInfinite where no move comes.
    struct Lowest {
        double height;
        Vec3d centre;
        std::uint32_t move;  // of several the first
    };
    Lowest lowest(double x, double y) const;

    // The same after one move alone, which is a convex function of (x, y).
    Lowest cut_by(std::uint32_t move, double x, double y) const;

private:
    using Key = std::uint64_t;
    static constexpr std::int64_t kBlock = 8;  // squares, each way
    struct Square {
        double low{kInfinite};  // mm: least height of a centre
        std::vector<std::uint32_t> moves;
    };
    struct Block {
        double low{kInfinite};
        std::array<Square, kBlock * kBlock> squares;
    };
    // Calls visit(number) for the moves in the squares within reach of the centre, some repeatedly.
    template <class Visit>
    void visit_around(Vec3d centre, const Visit& visit) const;
    // Share of the move where the ball is lowest straight over (x, y); none where it misses.
    std::optional<double> lowest_share(const Move& move, double x, double y) const;
    void try_move(std::uint32_t number, double x, double y, Lowest& best) const;
    bool may_be_lower(double low, Vec2d corner, double side, Vec2d at, double than) const;
    static std::size_t number_in_block(std::int64_t i, std::int64_t j);
    std::int64_t cell(double at) const;

    double radius_;
    double pitch_;
    std::vector<Move> moves_;
    std::unordered_map<Key, Block> blocks_;
    // The lowest move of the last query: usually low here too.
    mutable std::atomic<std::uint32_t> last_{0};
};

}  // namespace cusp::finishing
