// Greedy order, or the one given. A link lies on the model, or is a retract and an entry.
#include "host_tools/finishing/pass_links.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "host_tools/toolpath/toolpath_measure.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::finishing {

using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::ToolMove;
using toolpath::ToolpathWriter;

namespace {

constexpr double kSamePlace = 1e-6;   // mm
constexpr double kLongestDetour = 3;  // times the distance; beyond it a retract is better

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(b.x - a.x, b.y - a.y); }

// From the end of the last move back to `start`.
std::vector<ToolMove> reversed_moves(Vec3d start, const std::vector<ToolMove>& moves)
{
    std::vector<ToolMove> out;
    for (std::size_t k = moves.size(); k-- > 0;) {
        const Vec3d end = k > 0 ? end_of(moves[k - 1]) : start;
        ToolMove move = moves[k];
        if (ArcTo* arc = std::get_if<ArcTo>(&move.shape)) {
            arc->end = end;
            arc->clockwise = !arc->clockwise;
        } else {
            move.shape = LineTo{end};
        }
        out.push_back(move);
    }
    return out;
}

void reverse(SurfacePass& pass)
{
    std::reverse(pass.points.begin(), pass.points.end());
    if (pass.curve) {
        pass.curve = reversed(*pass.curve);
    }
    if (!pass.moves.empty()) {
        pass.moves = reversed_moves(pass.points.back(), pass.moves);
    }
}

class Linker {
public:
    Linker(const LinkRules& rules, GougeFreePathFitter& path_fitter)
        : rules_{rules}, path_fitter_{path_fitter}, writer_{out_.moves, {rules.clearance_z}}
    {
    }

    void add(const SurfacePass& pass)
    {
        const Vec3d start = pass.points.front();
        if (!writer_.started() || !stay_down(start)) {
            enter(start);
        }
        append(pass);
        out_.cut_length += length_of(pass.points);
    }

    LinkedPasses finish()
    {
        // Only retracts between passes count.
        out_.retracts = writer_.retracts();
        writer_.retract();
        out_.points = static_cast<int>(out_.moves.size());
        return std::move(out_);
    }

private:
    void enter(Vec3d start)
    {
        const bool over = rules_.plunge_from > start.z;
        writer_.approach(in_plan(start), over ? rules_.plunge_from : rules_.clearance_z);
        writer_.line(MoveKind::kPlunge, start);
    }

    bool stay_down(Vec3d start)
    {
        const Vec3d at = writer_.at();
        const double direct = norm(start - at);
        if (direct <= kSamePlace) {
            return true;
        }
        if (plan_distance(at, start) > rules_.stay_down) {
            return false;
        }
        Points way{at, start};
        if (!path_fitter_.clears_edges(at, start) || !path_fitter_.is_line_clear(at, start)) {
            way = {at};
            const Points over = path_fitter_.sample_dropped(at, start);
            way.insert(way.end(), over.begin(), over.end());
            way.push_back(start);
            const double length = length_of(way);
            if (length > std::max(kLongestDetour * direct, rules_.stay_down)) {
                return false;
            }
            way = path_fitter_.fit_lines(path_fitter_.moved_clear_of_edges(way));
        }
        for (std::size_t k = 1; k < way.size(); ++k) {
            out_.link_length += norm(way[k] - writer_.at());
            writer_.line(MoveKind::kLink, way[k]);
        }
        return true;
    }

    void append(const SurfacePass& pass)
    {
        if (pass.curve) {
            writer_.add({MoveKind::kCut, NurbsTo{*pass.curve}});
            return;
        }
        for (const ToolMove& move : pass.moves) {
            writer_.add(move);
        }
        for (std::size_t k = 1; pass.moves.empty() && k < pass.points.size(); ++k) {
            writer_.line(MoveKind::kCut, pass.points[k]);
        }
    }

    const LinkRules& rules_;
    GougeFreePathFitter& path_fitter_;
    LinkedPasses out_;
    ToolpathWriter writer_;
};

}  // namespace

LinkedPasses link_passes(std::vector<SurfacePass> passes,
                         const LinkRules& rules,
                         GougeFreePathFitter& path_fitter)
{
    Linker linker{rules, path_fitter};
    std::vector<bool> done(passes.size(), false);
    std::size_t next = 0;
    for (std::size_t count = 0; count < passes.size(); ++count) {
        done[next] = true;
        linker.add(passes[next]);
        if (rules.one_way) {
            ++next;
            continue;
        }
        const Vec3d at = passes[next].points.back();
        double nearest = kInfinite;
        bool turned = false;
        for (std::size_t k = 0; k < passes.size(); ++k) {
            if (done[k]) {
                continue;
            }
            const double forward = norm(passes[k].points.front() - at);
            const double backward = norm(passes[k].points.back() - at);
            if (std::min(forward, backward) < nearest - kSamePlace) {
                nearest = std::min(forward, backward);
                next = k;
                turned = backward < forward;
            }
        }
        if (turned) {
            reverse(passes[next]);
        }
    }
    return linker.finish();
}

}  // namespace cusp::finishing
