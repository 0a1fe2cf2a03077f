// A pass is a row of pieces, lines or moves; each is idle or not.
#include "host_tools/cam/finishing/passes_in_stock.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::finishing {

using toolpath::LineTo;
using toolpath::points_of;
using toolpath::ToolMove;

namespace {

constexpr double kChord = 1e-4;  // mm: of points along a move

struct PassPiece {
    Vec3d begin;
    Points way;   // after `begin`
    bool over{};  // it is idle
    double length{};
};

PassPiece piece_of(Vec3d begin, Points way, const IsIdle& is_idle)
{
    PassPiece piece{begin, std::move(way), true, 0};
    for (const Vec3d& at : piece.way) {
        piece.over = piece.over && is_idle(begin, at);
        piece.length += norm(at - begin);
        begin = at;
    }
    return piece;
}

std::vector<PassPiece> pieces_of(const SurfacePass& pass, const IsIdle& is_idle)
{
    std::vector<PassPiece> out;
    Vec3d at = pass.points.front();
    if (pass.moves.empty()) {
        for (std::size_t k = 1; k < pass.points.size(); ++k) {
            out.push_back(piece_of(at, {pass.points[k]}, is_idle));
            at = pass.points[k];
        }
    }
    for (const ToolMove& move : pass.moves) {
        out.push_back(piece_of(at, points_of(move, at, kChord), is_idle));
        at = end_of(move);
    }
    return out;
}

// The pieces [first, last) as a pass.
SurfacePass part_of(const SurfacePass& pass,
                    const std::vector<PassPiece>& pieces,
                    std::size_t first,
                    std::size_t last)
{
    SurfacePass part;
    part.points.push_back(pieces[first].begin);
    for (std::size_t k = first; k < last; ++k) {
        part.points.push_back(pieces[k].way.back());
        if (!pass.moves.empty()) {
            part.moves.push_back(pass.moves[k]);
        }
    }
    return part;
}

void add_parts(const SurfacePass& pass,
               const IsIdle& is_idle,
               double linked,
               std::vector<SurfacePass>& out)
{
    const std::vector<PassPiece> pieces = pieces_of(pass, is_idle);
    std::size_t first = 0;  // of the part
    std::size_t last = 0;   // behind its last piece in the stock
    double over = 0;        // mm, since then
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (pieces[k].over) {
            over += pieces[k].length;
            continue;
        }
        if (last > first && over <= linked) {
            last = k + 1;
        } else {
            if (last > first) {
                out.push_back(part_of(pass, pieces, first, last));
            }
            first = k;
            last = k + 1;
        }
        over = 0;
    }
    if (last > first) {
        out.push_back(part_of(pass, pieces, first, last));
    }
}

// The places on a line where an idle part begins or ends, then its end.
Points ends_of_idle_parts(Vec3d from, Vec3d to, const IsIdle& is_idle)
{
    constexpr double kGrain = 0.5;  // mm
    const int n = std::max(1, static_cast<int>(norm(to - from) / kGrain));
    const auto at = [&](int i) {
        return i == n ? to : from + (to - from) * (1.0 * i / n);
    };
    Points out;
    bool was_idle = n > 1 && is_idle(from, at(1));
    for (int i = 1; i < n; ++i) {
        const bool idle = is_idle(at(i), at(i + 1));
        if (idle != was_idle) {
            out.push_back(at(i));
        }
        was_idle = idle;
    }
    out.push_back(to);
    return out;
}

}  // namespace

SurfacePass divided_where_idle(const SurfacePass& pass, const IsIdle& is_idle)
{
    if (pass.curve) {
        return pass;
    }
    SurfacePass out{{pass.points.front()}, {}, {}};
    Vec3d at = pass.points.front();
    const auto add_line = [&](Vec3d to) {
        const Points ends = ends_of_idle_parts(at, to, is_idle);
        out.points.insert(out.points.end(), ends.begin(), ends.end());
        return ends;
    };
    for (std::size_t k = 1; pass.moves.empty() && k < pass.points.size(); ++k) {
        add_line(pass.points[k]);
        at = pass.points[k];
    }
    for (const ToolMove& move : pass.moves) {
        if (std::holds_alternative<LineTo>(move.shape)) {
            for (const Vec3d end : add_line(end_of(move))) {
                out.moves.push_back({move.kind, LineTo{end}});
            }
        } else {
            out.points.push_back(end_of(move));
            out.moves.push_back(move);
        }
        at = end_of(move);
    }
    return out;
}

std::vector<SurfacePass> passes_in_stock(const std::vector<SurfacePass>& passes,
                                         const IsIdle& is_idle,
                                         double linked)
{
    const auto is_low = [&](const Vec3d& at) {
        return !is_idle(at, at);
    };
    std::vector<SurfacePass> out;
    for (const SurfacePass& pass : passes) {
        const auto low = std::count_if(pass.points.begin(), pass.points.end(), is_low);
        const bool whole = static_cast<std::size_t>(low) == pass.points.size();
        if (whole || (pass.curve && low > 0)) {
            out.push_back(pass);
        } else if (!pass.curve) {
            add_parts(pass, is_idle, linked, out);
        }
    }
    return out;
}

}  // namespace cusp::finishing
