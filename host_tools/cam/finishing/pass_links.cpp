// Greedy order, or the one given; then all links, on several threads. A link lies on the model, or is a
// retract and an entry.
#include "host_tools/cam/finishing/pass_links.hpp"

#include <algorithm>
#include <variant>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::finishing {

using part_model::PartModel;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::ToolMove;
using toolpath::ToolpathWriter;

namespace {

constexpr double kSamePlace = 1e-6;      // mm
constexpr std::size_t kLinksAtOnce = 8;  // of one thread
constexpr double kLongestDetour = 3;     // times the distance; beyond it a retract is better

double plan_distance(Vec3d a, Vec3d b) { return elementary::hypot(b.x - a.x, b.y - a.y); }

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

Vec3d end_of(const SurfacePass& pass)
{
    return pass.curve || pass.moves.empty() ? pass.points.back()
                                            : toolpath::end_of(pass.moves.back());
}

// Points of a link on the model; none where the tool retracts.
std::optional<Points> way_between(Vec3d at,
                                  Vec3d start,
                                  const LinkRules& rules,
                                  GougeFreePathFitter& path_fitter)
{
    const double direct = norm(start - at);
    if (direct <= kSamePlace) {
        return Points{at};
    }
    if (plan_distance(at, start) > rules.stay_down) {
        return std::nullopt;
    }
    if (path_fitter.clears_edges(at, start) && path_fitter.is_line_clear(at, start)) {
        return Points{at, start};
    }
    Points way{at};
    const Points over = path_fitter.sample_dropped(at, start);
    way.insert(way.end(), over.begin(), over.end());
    way.push_back(start);
    if (length_of(way) > std::max(kLongestDetour * direct, rules.stay_down)) {
        return std::nullopt;
    }
    return path_fitter.fit_lines(path_fitter.moved_clear_of_edges(way));
}

// To each pass from the one before; none to the first.
std::vector<std::optional<Points>> ways_between(const std::vector<SurfacePass>& passes,
                                                const LinkRules& rules,
                                                GougeFreePathFitter& path_fitter)
{
    std::vector<std::optional<Points>> out(passes.size());
    std::vector<double> least((passes.size() + kLinksAtOnce - 1) / kLinksAtOnce);
    const PartModel::SharedQueries shared{path_fitter.model()};
    parallel::for_each(least.size(), [&](std::size_t some) {
        const PartModel::SharedQueries::Part queries{path_fitter.model()};
        GougeFreePathFitter fitter = path_fitter;
        const std::size_t end = std::min(passes.size(), (some + 1) * kLinksAtOnce);
        for (std::size_t k = std::max<std::size_t>(1, some * kLinksAtOnce); k < end; ++k) {
            out[k] = way_between(end_of(passes[k - 1]), passes[k].points.front(), rules, fitter);
        }
        least[some] = fitter.least_clearance();
    });
    path_fitter.model().forget_queries();
    for (const double clearance : least) {
        path_fitter.include_moves_with(clearance);
    }
    return out;
}

class Linker {
public:
    explicit Linker(const LinkRules& rules)
        : rules_{rules}, writer_{out_.moves, {rules.clearance_z}}
    {
    }

    void add(const SurfacePass& pass, const std::optional<Points>& way)
    {
        if (way) {
            link(*way);
        } else {
            enter(pass.points.front());
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

    void link(const Points& way)
    {
        for (std::size_t k = 1; k < way.size(); ++k) {
            out_.link_length += norm(way[k] - writer_.at());
            writer_.line(MoveKind::kLink, way[k]);
        }
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
    LinkedPasses out_;
    ToolpathWriter writer_;
};

// Always the nearest end next.
std::vector<SurfacePass> in_greedy_order(std::vector<SurfacePass> passes)
{
    std::vector<SurfacePass> out;
    std::vector<bool> done(passes.size(), false);
    std::size_t next = 0;
    while (out.size() < passes.size()) {
        done[next] = true;
        out.push_back(std::move(passes[next]));
        const Vec3d at = out.back().points.back();
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
    return out;
}

}  // namespace

LinkedPasses link_passes(std::vector<SurfacePass> passes,
                         const LinkRules& rules,
                         GougeFreePathFitter& path_fitter)
{
    const std::vector<SurfacePass> ordered =
        rules.one_way ? std::move(passes) : in_greedy_order(std::move(passes));
    const std::vector<std::optional<Points>> ways = ways_between(ordered, rules, path_fitter);
    Linker linker{rules};
    for (std::size_t k = 0; k < ordered.size(); ++k) {
        linker.add(ordered[k], ways[k]);
    }
    return linker.finish();
}

}  // namespace cusp::finishing
