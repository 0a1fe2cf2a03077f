// Greedy order, or the one given; then all links, on several threads. A link lies on the model, or is a
// retract and an entry.
#include "host_tools/cam/finishing/pass_links.hpp"

#include <algorithm>
#include <variant>

#include "firmware/base/math.hpp"
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
constexpr int kLeadMoves = 8;            // of a quarter turn

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

// A level quarter turn that ends at a pass, tangent to its way there, beside the part and clear of it; none
// where neither side has room.
//
// way  of the tool, from `at` on
std::optional<Points> lead_to(Vec3d at, Vec3d way, double radius, GougeFreePathFitter& path_fitter)
{
    const double level = elementary::hypot(way.x, way.y);
    if (!(radius > 0) || !(level > 0)) {
        return std::nullopt;
    }
    const Vec3d along{way.x / level, way.y / level, 0};
    for (const double turn : {radius, -radius, 0.5 * radius, -0.5 * radius}) {
        const Vec3d centre = at + Vec3d{-along.y, along.x, 0} * turn;
        const Vec3d out = at - centre;
        Points lead;
        for (int k = kLeadMoves; k >= 0; --k) {
            const double angle = 0.5 * kPi * k / kLeadMoves;
            lead.push_back(centre + out * elementary::cos(angle) -
                           along * (std::abs(turn) * elementary::sin(angle)));
        }
        bool clear = true;
        for (std::size_t k = 1; clear && k < lead.size(); ++k) {
            clear = path_fitter.clears_edges(lead[k - 1], lead[k]) &&
                    path_fitter.is_line_clear(lead[k - 1], lead[k]);
        }
        if (clear) {
            lead.back() = at;
            return lead;
        }
    }
    return std::nullopt;
}

Vec3d way_in(const SurfacePass& pass) { return pass.points[1] - pass.points[0]; }
Vec3d way_out(const SurfacePass& pass)
{
    return pass.points[pass.points.size() - 2] - pass.points.back();
}

class Linker {
public:
    Linker(const LinkRules& rules, GougeFreePathFitter& path_fitter)
        : rules_{rules}, path_fitter_{path_fitter}, writer_{out_.moves, {rules.clearance_z}}
    {
    }

    void add(const SurfacePass& pass, const std::optional<Points>& way)
    {
        if (way) {
            link(*way);
        } else {
            leave();
            enter(pass);
        }
        append(pass);
        out_.cut_length += length_of(pass.points);
        last_ = &pass;
    }

    LinkedPasses finish()
    {
        leave();
        // Only retracts between passes count.
        out_.retracts = writer_.retracts();
        writer_.retract();
        out_.points = static_cast<int>(out_.moves.size());
        return std::move(out_);
    }

private:
    void enter(const SurfacePass& pass)
    {
        const std::optional<Points> lead =
            lead_to(pass.points.front(), way_in(pass), rules_.lead_in, path_fitter_);
        const Vec3d start = lead ? lead->front() : pass.points.front();
        const bool over = rules_.plunge_from > start.z;
        writer_.approach(in_plan(start), over ? rules_.plunge_from : rules_.clearance_z);
        writer_.line(MoveKind::kPlunge, start);
        if (lead) {
            link(*lead);
        }
    }

    // Before a retract.
    void leave()
    {
        if (last_ == nullptr) {
            return;
        }
        if (std::optional<Points> lead =
                lead_to(end_of(*last_), way_out(*last_), rules_.lead_in, path_fitter_)) {
            std::reverse(lead->begin(), lead->end());
            link(*lead);
        }
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
    GougeFreePathFitter& path_fitter_;
    LinkedPasses out_;
    ToolpathWriter writer_;
    const SurfacePass* last_{nullptr};
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
    Linker linker{rules, path_fitter};
    for (std::size_t k = 0; k < ordered.size(); ++k) {
        linker.add(ordered[k], ways[k]);
    }
    return linker.finish();
}

}  // namespace cusp::finishing
