// A pass is a row of pieces, lines or moves; each is over the stock or not.
#include "host_tools/cam/finishing/passes_in_stock.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::finishing {

using toolpath::points_of;
using toolpath::ToolMove;

namespace {

constexpr double kSame = 1e-6;   // mm: rounding of a tip on the stock's top
constexpr double kChord = 1e-4;  // mm: of points along a move

bool is_over(const Points& points, double top)
{
    return std::all_of(points.begin(), points.end(),
                       [&](const Vec3d& at) { return at.z >= top - kSame; });
}

struct PassPiece {
    Vec3d begin;
    Points way;  // after `begin`
    bool over{};
    double length{};
};

PassPiece piece_of(Vec3d begin, Points way, double top)
{
    PassPiece piece{begin, std::move(way), begin.z >= top - kSame, 0};
    piece.over = piece.over && is_over(piece.way, top);
    for (const Vec3d& at : piece.way) {
        piece.length += norm(at - begin);
        begin = at;
    }
    return piece;
}

std::vector<PassPiece> pieces_of(const SurfacePass& pass, double top)
{
    std::vector<PassPiece> out;
    Vec3d at = pass.points.front();
    if (pass.moves.empty()) {
        for (std::size_t k = 1; k < pass.points.size(); ++k) {
            out.push_back(piece_of(at, {pass.points[k]}, top));
            at = pass.points[k];
        }
    }
    for (const ToolMove& move : pass.moves) {
        out.push_back(piece_of(at, points_of(move, at, kChord), top));
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

void add_parts(const SurfacePass& pass, double top, double linked, std::vector<SurfacePass>& out)
{
    const std::vector<PassPiece> pieces = pieces_of(pass, top);
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

}  // namespace

std::vector<SurfacePass> passes_in_stock(const std::vector<SurfacePass>& passes,
                                         double top,
                                         double linked)
{
    const auto is_low = [&](const Vec3d& at) {
        return at.z < top - kSame;
    };
    std::vector<SurfacePass> out;
    for (const SurfacePass& pass : passes) {
        const auto low = std::count_if(pass.points.begin(), pass.points.end(), is_low);
        const bool whole = static_cast<std::size_t>(low) == pass.points.size();
        if (whole || (pass.curve && low > 0)) {
            out.push_back(pass);
        } else if (!pass.curve) {
            add_parts(pass, top, linked, out);
        }
    }
    return out;
}

}  // namespace cusp::finishing
