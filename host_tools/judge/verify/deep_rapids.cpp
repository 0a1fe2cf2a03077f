// Straight pieces of each run, in order: rapid ones are looked at in what those before them have left.
#include "host_tools/judge/verify/deep_rapids.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/judge/verify/cut_stock.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"

namespace cusp::verify {

using job::Job;

namespace {

// Positions of one move along a line.
struct Piece {
    Vec3d from;
    Vec3d to;
    bool rapid;
    std::uint32_t line;
};

bool goes_on(const Piece& piece, const Piece& next)
{
    constexpr double kStraight = 1e-9;
    const Vec3d a = piece.to - piece.from;
    const Vec3d b = next.to - next.from;
    return piece.rapid == next.rapid && (!piece.rapid || piece.line == next.line) &&
           dot(a, b) > 0 && norm(cross(a, b)) <= kStraight * norm(a) * norm(b);
}

template <typename Visit>
void visit_pieces(const ToolPositions& run, Visit visit)
{
    std::optional<Piece> piece;
    for (std::size_t k = 1; k < run.tips.size(); ++k) {
        const Piece next{run.tips[k - 1], run.tips[k], run.rapid[k], run.lines[k]};
        if (piece && goes_on(*piece, next)) {
            piece->to = next.to;
            continue;
        }
        if (piece) {
            visit(*piece);
        }
        piece = next;
    }
    if (piece) {
        visit(*piece);
    }
}

// A rapid piece is looked at where it is in reach of stock; straight up the tool goes where it has been.
bool is_looked_at(const Piece& piece, double top)
{
    const bool goes_up =
        piece.from.x == piece.to.x && piece.from.y == piece.to.y && piece.to.z >= piece.from.z;
    return piece.rapid && !goes_up && std::min(piece.from.z, piece.to.z) < top;
}

void cut(CutStock& stock, const toolpath::Tool& tool, const Piece& piece, RapidCut rapids)
{
    const bool at_end = piece.rapid && rapids == RapidCut::kAtEnd;
    stock.cut(tool, at_end ? piece.to : piece.from, piece.to);
}

// A piece of a rapid move, and the cuts before it.
struct Look {
    std::size_t run;
    std::uint32_t line;
    ToolWay way;
    ToolWay end;
    std::size_t cuts;
};

std::vector<Look> looks_of(const std::vector<ToolPositions>& runs, double top)
{
    std::vector<Look> looks;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        visit_pieces(runs[r], [&](const Piece& piece) {
            if (is_looked_at(piece, top)) {
                looks.push_back({r, piece.line,
                                 CutStock::way_of(runs[r].tool, piece.from, piece.to),
                                 CutStock::way_of(runs[r].tool, piece.to, piece.to), 0});
            }
        });
    }
    return looks;
}

}  // namespace

std::vector<RapidOfRun> deep_rapids(const Job& job,
                                    const std::vector<ToolPositions>& runs,
                                    double spacing,
                                    const PartBox& box,
                                    RapidCut rapids)
{
    std::vector<Look> looks = looks_of(runs, job.stock_top);
    if (looks.empty()) {
        return {};
    }
    std::vector<ToolWay> ways;
    for (const Look& look : looks) {
        ways.push_back(look.way);
    }
    CutStock stock{job, box, ways};
    const std::vector<ToolPositions> earlier = earlier_positions(job, spacing);
    for (const ToolPositions& run : earlier) {
        visit_pieces(run, [&](const Piece& piece) { cut(stock, run.tool, piece, rapids); });
    }
    auto next = looks.begin();
    for (const ToolPositions& run : runs) {
        visit_pieces(run, [&](const Piece& piece) {
            if (is_looked_at(piece, job.stock_top)) {
                (next++)->cuts = stock.cuts();
            }
            cut(stock, run.tool, piece, rapids);
        });
    }
    std::vector<std::optional<RapidOfRun>> found(looks.size());
    parallel::for_each(looks.size(), [&](std::size_t k) {
        const Look& look = looks[k];
        if (const auto standing = stock.under(look.way, look.cuts)) {
            const auto at_end = stock.under(look.end, look.cuts);
            found[k] = {look.run, look.line, standing->depth, standing->tip,
                        at_end ? at_end->depth : 0.0};
        }
    });
    std::map<std::pair<std::size_t, std::uint32_t>, RapidOfRun> by_move;
    for (const std::optional<RapidOfRun>& rapid : found) {
        if (rapid) {
            RapidOfRun& known =
                by_move.try_emplace({rapid->run, rapid->line}, *rapid).first->second;
            const double end_depth = std::max(known.end_depth, rapid->end_depth);
            known = rapid->depth > known.depth ? *rapid : known;
            known.end_depth = end_depth;
        }
    }
    std::vector<RapidOfRun> out;
    for (const auto& [move, rapid] : by_move) {
        out.push_back(rapid);
    }
    return out;
}

}  // namespace cusp::verify
