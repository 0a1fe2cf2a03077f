// Cuts the stock in memory, up to the last move that is too steep.
#include "host_tools/cam/clearing/plunge_feed_limit.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/clearing/stock_height_map.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::clearing {

using job::Job;
using offset::Box2d;
using offset::Edge;
using offset::EdgeTree;
using offset::line_edge;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

constexpr double kStockPitch = 1.0 / 12;  // of the finest tool's radius
constexpr double kDescentChord = 0.002;   // mm: tolerance of chords of curves
constexpr double kBehind = 0.1;       // of the radius, in plan: distance up to which stock is cut
constexpr double kBelow = 0.85;       // of the radius: farther out, moves above meet stock
constexpr double kSkim = 0.05;        // of the radius: scallops between passes are no higher
constexpr double kOverDescent = 0.1;  // mm above the stock: vertical moves slow down

bool goes_at_feed(const ToolMove& move)
{
    return move.kind == MoveKind::kCut || move.kind == MoveKind::kLink;
}

// Per move, whether it descends too steeply for the feed. Adds the lines of such moves to `ways`.
std::vector<bool> steep_moves(const Toolpath& path, std::vector<Edge>& ways)
{
    const Vec2d grain{1e-6, 0.0};  // of vertical lines
    std::vector<bool> steep;
    Vec3d at{};
    for (const ToolMove& move : path.moves) {
        steep.push_back(goes_at_feed(move) && path.plunge_feed > 0.0 &&
                        steepest_descent(move, at) * path.feed > path.plunge_feed);
        Vec2d from{at.x, at.y};
        for (const Vec3d p : points_of(move, at, kDescentChord)) {
            if (steep.back()) {
                ways.push_back(line_edge(from, Vec2d{p.x, p.y} + grain));
            }
            from = {p.x, p.y};
            at = p;
        }
    }
    return steep;
}

class PlungeFeedLimiter {
public:
    // ways     of moves that may be too steep
    // largest  radius of a tool
    PlungeFeedLimiter(const StockHeightMap& stock, std::vector<Edge> ways, double largest)
        : stock_{stock}, moves_{std::move(ways)}, largest_{largest}
    {
    }

    // steep  which moves are too steep
    // left   number of them, here and in the paths that follow
    void run(PlannedOperation& operation, const std::vector<bool>& steep, std::ptrdiff_t& left)
    {
        Toolpath& path = operation.path;
        stock_.set_tool(path.tool);
        radius_ = path.tool.radius;
        std::vector<ToolMove> moves;
        for (std::size_t i = 0; i < path.moves.size(); ++i) {
            const ToolMove& move = path.moves[i];
            if (left == 0) {
                moves.push_back(move);
                continue;
            }
            if (steep[i]) {
                slow(move, moves);
                --left;
            } else {
                moves.push_back(move);
                for (const Vec3d p : points_of(move, at_, kDescentChord)) {
                    at_ = p;
                    ahead_.push_back(p);
                }
                if (i == 0) {
                    // The start of a path's first move is above the stock.
                    ahead_.clear();
                    cut_to_ = at_;
                }
                take_off(0.0);
            }
        }
        operation.stats.cl_points += static_cast<int>(moves.size() - path.moves.size());
        path.moves = std::move(moves);
    }

private:
    // Removes the cut of the moves up to where they are no farther away than `least`, mm.
    void take_off(double least)
    {
        std::size_t n = 0;
        for (; n < ahead_.size() && (least <= 0.0 || apart(ahead_[n]) > least); ++n) {
            const Vec3d to = ahead_[n];
            // Stock elsewhere is never queried.
            const double way = elementary::hypot(to.x - cut_to_.x, to.y - cut_to_.y);
            if (moves_.any_nearer({to.x, to.y}, 2.0 * largest_ + way)) {
                stock_.cut(cut_to_, to);
            }
            cut_to_ = to;
        }
        ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(n));
    }

    double apart(Vec3d p) const { return elementary::hypot(p.x - at_.x, p.y - at_.y); }

    bool is_in_stock() const
    {
        return stock_.contact_height({at_.x, at_.y}, kBelow) > at_.z + kSkim * radius_;
    }

    void slow(const ToolMove& move, std::vector<ToolMove>& moves)
    {
        const Vec3d start = at_;
        const Vec3d end = end_of(move);
        const double over = stock_.contact_height({start.x, start.y}, kBelow) + kOverDescent;
        const bool deep = cuts_deep(points_of(move, start, kDescentChord));
        if (deep && end.x == start.x && end.y == start.y && over < start.z) {
            moves.push_back({move.kind, LineTo{{end.x, end.y, over}}});
        }
        moves.push_back(move);
        moves.back().kind = deep ? MoveKind::kPlungingCut : move.kind;
    }

    // Cuts just before do not count: they would hide the depth of the stock below a vertical move.
    bool cuts_deep(const std::vector<Vec3d>& places)
    {
        bool deep = false;
        for (const Vec3d p : places) {
            const Vec3d from = at_;
            const int n = 1 + static_cast<int>(norm(p - from) / (kBehind * radius_));
            for (int i = 1; i <= n; ++i) {
                at_ = from + (p - from) * (static_cast<double>(i) / n);
                ahead_.push_back(at_);
                take_off(kBehind * radius_);
                deep = deep || (p.z < from.z && is_in_stock());
            }
            at_ = p;
        }
        return deep;
    }

    StockHeightMap stock_;
    EdgeTree moves_;
    double largest_;
    double radius_{};
    Vec3d at_{};
    std::vector<Vec3d> ahead_;  // points of moves that are not cut yet
    Vec3d cut_to_{};
};

}  // namespace

void limit_plunge_feed(std::vector<PlannedOperation>& operations, const Job& job, const Box2d& box)
{
    std::vector<std::vector<bool>> steep;
    std::vector<Edge> ways;
    std::ptrdiff_t left = 0;
    Tool finest = operations.front().path.tool;
    double largest = 0.0;
    for (const PlannedOperation& operation : operations) {
        const Tool& tool = operation.path.tool;
        steep.push_back(steep_moves(operation.path, ways));
        left += std::count(steep.back().begin(), steep.back().end(), true);
        finest = tool.radius < finest.radius ? tool : finest;
        largest = std::max(largest, tool.radius);
    }
    if (left == 0) {
        return;
    }
    PlungeFeedLimiter slower{{box, finest, job.stock_top, kStockPitch}, std::move(ways), largest};
    for (std::size_t i = 0; i < operations.size(); ++i) {
        slower.run(operations[i], steep[i], left);
    }
}

}  // namespace cusp::clearing
