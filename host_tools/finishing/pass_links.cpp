// Greedy order, or the one given. A link lies on the model, or is a retract and an entry.
#include "host_tools/finishing/pass_links.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::finishing {

using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::ToolMove;

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

void turn_round(SurfacePass& pass)
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
        : rules_{rules}, path_fitter_{path_fitter}
    {
    }

    void add(const SurfacePass& pass)
    {
        const Vec3d start = pass.points.front();
        if (out_.moves.empty()) {
            enter(start);
        } else if (!stay_down(start)) {
            retract();
            ++out_.retracts;
            enter(start);
        }
        append(pass);
        out_.cut_length += length_of(pass.points);
        at_ = pass.points.back();
    }

    LinkedPasses finish()
    {
        if (!out_.moves.empty()) {
            retract();
        }
        return std::move(out_);
    }

private:
    void line(MoveKind kind, Vec3d to)
    {
        out_.moves.push_back({kind, LineTo{to}});
        at_ = to;
        ++out_.points;
    }

    void enter(Vec3d start)
    {
        line(MoveKind::kRapid, {start.x, start.y, rules_.clearance_z});
        if (rules_.plunge_from < rules_.clearance_z && rules_.plunge_from > start.z) {
            line(MoveKind::kRapid, {start.x, start.y, rules_.plunge_from});
        }
        line(MoveKind::kPlunge, start);
    }

    void retract() { line(MoveKind::kRapid, {at_.x, at_.y, rules_.clearance_z}); }

    bool stay_down(Vec3d start)
    {
        const double direct = norm(start - at_);
        if (direct <= kSamePlace) {
            return true;
        }
        if (plan_distance(at_, start) > rules_.stay_down) {
            return false;
        }
        Points way{at_, start};
        if (!path_fitter_.clears_edges(at_, start) || !path_fitter_.is_line_clear(at_, start)) {
            way = {at_};
            const Points over = path_fitter_.sample_dropped(at_, start);
            way.insert(way.end(), over.begin(), over.end());
            way.push_back(start);
            const double length = length_of(way);
            if (length > std::max(kLongestDetour * direct, rules_.stay_down)) {
                return false;
            }
            way = path_fitter_.fit_lines(path_fitter_.moved_clear_of_edges(way));
        }
        for (std::size_t k = 1; k < way.size(); ++k) {
            out_.link_length += norm(way[k] - at_);
            line(MoveKind::kLink, way[k]);
        }
        return true;
    }

    void append(const SurfacePass& pass)
    {
        if (pass.curve) {
            out_.moves.push_back({MoveKind::kCut, NurbsTo{*pass.curve}});
            ++out_.points;
            return;
        }
        if (!pass.moves.empty()) {
            out_.moves.insert(out_.moves.end(), pass.moves.begin(), pass.moves.end());
            out_.points += static_cast<int>(pass.moves.size());
            return;
        }
        for (std::size_t k = 1; k < pass.points.size(); ++k) {
            line(MoveKind::kCut, pass.points[k]);
        }
    }

    const LinkRules& rules_;
    GougeFreePathFitter& path_fitter_;
    LinkedPasses out_;
    Vec3d at_;
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
            turn_round(passes[next]);
        }
    }
    return linker.finish();
}

}  // namespace cusp::finishing
