// Isocurves keep their parameters on the offset; the model decides which parts remain.
#include "host_tools/cam/adaptive_isocurve/offset_curve_trimmer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/adaptive_isocurve/dense_tips.hpp"
#include "host_tools/geometry/part_model/cell_chains.hpp"
#include "host_tools/geometry/part_model/surface_length.hpp"

namespace cusp::adaptive_isocurve {

using finishing::length_of;
using finishing::Points;
using nurbs::Surface;
using part_model::CellChains;
using part_model::end_node;
using part_model::GridSide;
using part_model::PartModel;

namespace {

constexpr double kTrimSpacing = 1.0;  // mm between points that are checked
constexpr int kFewestChecks = 4;
constexpr int kEdgeHalvings = 22;
constexpr int kEdgeDeepest = 6;
constexpr double kEdgeFound = 0.01;       // of the band: accuracy of an edge
constexpr double kShortestTraced = 1e-3;  // mm
constexpr std::size_t kMostChecks = 500;
constexpr std::size_t kSidesOfAPart = 8;

double length_along(const PartModel& model, int surface, Vec2d from, Vec2d to)
{
    constexpr int kParts = 12;
    return length_between(model, surface, from, to, kParts);
}

// Calls work(list, k) for each k below the length of each list: `at_once` in turn are a part, parts of
// all lists on all cores.
void in_parts(const PartModel& model,
              const std::vector<std::size_t>& lengths,
              std::size_t at_once,
              const std::function<void(std::size_t, std::size_t)>& work)
{
    struct Part {
        std::size_t list;
        std::size_t begin;
        std::size_t end;
    };
    std::vector<Part> parts;
    for (std::size_t list = 0; list < lengths.size(); ++list) {
        for (std::size_t begin = 0; begin < lengths[list]; begin += at_once) {
            parts.push_back({list, begin, std::min(lengths[list], begin + at_once)});
        }
    }
    {
        const PartModel::SharedQueries shared{model};
        parallel::for_each(parts.size(), [&](std::size_t number) {
            const PartModel::SharedQueries::Part queries{model};
            const Part& part = parts[number];
            for (std::size_t k = part.begin; k < part.end; ++k) {
                work(part.list, k);
            }
        });
    }
    model.forget_queries();
}

std::vector<double> even(double from, double to, std::size_t parts)
{
    std::vector<double> out;
    for (std::size_t k = 0; k <= parts; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(parts);
        out.push_back(from * (1 - t) + to * t);
    }
    return out;
}

}  // namespace

Vec3d OffsetCurveTrimmer::tip(int surface, double u, double v) const
{
    return path_fitter_.tip_at(surface, u, v);
}

bool OffsetCurveTrimmer::is_clear_at(int surface, double u, double v) const
{
    return path_fitter_.model().inside_trims(surface, u, v) &&
           path_fitter_.is_clear_at_contact(surface, u, v);
}

TracedPiece OffsetCurveTrimmer::along(const DomainCurve& curve, double from, double to) const
{
    const double length = length_along(path_fitter_.model(), curve.surface,
                                       {from, curve.v_at(from)}, {to, curve.v_at(to)});
    const std::size_t parts =
        std::max<std::size_t>(2, static_cast<std::size_t>(length / (1.5 * kTrimSpacing)));
    DenseTips tips = dense_tips(
        path_fitter_, [&](double u) { return tip(curve.surface, u, curve.v_at(u)); },
        even(from, to, 2 * parts));
    TracedPiece piece{std::move(tips.points), {}, from, to};
    for (const double u : tips.u) {
        piece.cc_parameters.push_back({curve.surface, u, curve.v_at(u)});
    }
    return piece;
}

TracedCurve OffsetCurveTrimmer::trace(const DomainCurve& curve) const
{
    const double u0 = curve.u.front();
    const double u1 = curve.u.back();
    const double length = length_along(path_fitter_.model(), curve.surface, {u0, curve.v.front()},
                                       {u1, curve.v.back()});
    const std::size_t parts =
        static_cast<std::size_t>(std::max<double>(kFewestChecks, std::ceil(length / kTrimSpacing)));
    const std::vector<double> checks = even(u0, u1, parts);
    const auto free = [&](double u) {
        return is_clear_at(curve.surface, u, curve.v_at(u));
    };
    TracedCurve out;
    const auto note_blocked = [&](double u) {
        out.blocked =
            out.blocked || path_fitter_.model().inside_trims(curve.surface, u, curve.v_at(u));
    };
    double begin = u0;
    bool was_free = free(u0);
    if (!was_free) {
        note_blocked(u0);
    }
    const auto close = [&](double end) {
        if (end > begin) {
            TracedPiece piece = along(curve, begin, end);
            if (length_of(piece.points) > kShortestTraced) {
                out.pieces.push_back(std::move(piece));
            }
        }
    };
    for (std::size_t k = 1; k < checks.size(); ++k) {
        const bool is_free = free(checks[k]);
        if (!is_free) {
            note_blocked(checks[k]);
        }
        if (is_free == was_free) {
            continue;
        }
        double inside = is_free ? checks[k] : checks[k - 1];
        double outside = is_free ? checks[k - 1] : checks[k];
        for (int turn = 0; turn < kEdgeHalvings; ++turn) {
            const double middle = 0.5 * (inside + outside);
            (free(middle) ? inside : outside) = middle;
        }
        note_blocked(outside);
        if (is_free) {
            begin = inside;
        } else {
            close(inside);
        }
        was_free = is_free;
    }
    if (was_free) {
        close(u1);
    }
    return out;
}

std::vector<Points> OffsetCurveTrimmer::clear_region_edges(int surface, double spacing) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const PartModel& model = path_fitter_.model();
    const double u_middle = 0.5 * (s.u_begin() + s.u_end());
    const double v_middle = 0.5 * (s.v_begin() + s.v_end());
    const auto parts = [&](double length) {
        return std::clamp<std::size_t>(static_cast<std::size_t>(length / spacing), 8, kMostChecks);
    };
    const PartModel::SharedQueries shared{model};
    std::vector<double> us;
    std::vector<double> vs;
    {
        const PartModel::SharedQueries::Part queries{model};
        us = even(
            s.u_begin(), s.u_end(),
            parts(length_along(model, surface, {s.u_begin(), v_middle}, {s.u_end(), v_middle})));
        vs = even(
            s.v_begin(), s.v_end(),
            parts(length_along(model, surface, {u_middle, s.v_begin()}, {u_middle, s.v_end()})));
    }
    std::vector<char> free(us.size() * vs.size());  // no bits: rows are written at once
    in_parts(model, {us.size()}, 1, [&](std::size_t, std::size_t i) {
        for (std::size_t j = 0; j < vs.size(); ++j) {
            free[i * vs.size() + j] = is_clear_at(surface, us[i], vs[j]) ? 1 : 0;
        }
    });
    const auto place = [&](std::size_t k) {
        return Vec2d{us[k / vs.size()], vs[k % vs.size()]};
    };
    CellChains chains;
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            chains.join(i * vs.size() + j, vs.size(), [&](const GridSide& side) {
                return free[side.first] != free[end_node(side, vs.size())];
            });
        }
    }
    std::vector<std::vector<EdgeSide>> edges;
    for (const std::vector<GridSide>& chain : chains.chains()) {
        std::vector<EdgeSide>& sides = edges.emplace_back();
        for (const GridSide& side : chain) {
            const std::size_t node = side.first;
            const std::size_t other = end_node(side, vs.size());
            const bool is_free = free[node] != 0;
            sides.push_back({place(is_free ? node : other), place(is_free ? other : node)});
        }
    }
    std::vector<Points> out;
    for (Points& dense : along_edges(surface, edges)) {
        if (length_of(dense) > kShortestTraced) {
            out.push_back(std::move(dense));
        }
    }
    return out;
}

// Tips along each edge that the segments cross, in their order.
std::vector<Points> OffsetCurveTrimmer::along_edges(
    int surface, const std::vector<std::vector<EdgeSide>>& edges) const
{
    const PartModel& model = path_fitter_.model();
    std::vector<std::size_t> counts;
    std::vector<std::size_t> spans;
    std::vector<Points> tips;
    std::vector<std::vector<std::optional<Points>>> between;  // two of them
    for (const std::vector<EdgeSide>& sides : edges) {
        counts.push_back(sides.size());
        spans.push_back(sides.size() - 1);
        tips.emplace_back(sides.size());
        between.emplace_back(sides.size());
    }
    in_parts(model, counts, kSidesOfAPart, [&](std::size_t edge, std::size_t k) {
        tips[edge][k] = edge_tip(surface, edges[edge][k]);
    });
    in_parts(model, spans, kSidesOfAPart, [&](std::size_t edge, std::size_t k) {
        const Vec3d a = tips[edge][k];
        const Vec3d b = tips[edge][k + 1];
        between[edge][k] = edge_points(surface, edges[edge][k], edges[edge][k + 1], a, b);
        if (!between[edge][k]) {
            between[edge][k] = path_fitter_.sample_dropped(a, b);
        }
    });
    std::vector<Points> out;
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
        Points& dense = out.emplace_back(Points{tips[edge].front()});
        for (std::size_t k = 0; k < spans[edge]; ++k) {
            const Points& piece = *between[edge][k];
            dense.insert(dense.end(), piece.begin() + 1, piece.end());
        }
    }
    return out;
}

// The last clear tip towards the blocked point.
Vec3d OffsetCurveTrimmer::edge_tip(int surface, const EdgeSide& side) const
{
    double inside = 0;
    double outside = 1;
    const auto place = [&](double share) {
        return side.free + (side.blocked - side.free) * share;
    };
    const double found = kEdgeFound * path_fitter_.band().half_width;
    double apart =
        norm(tip(surface, side.blocked.x, side.blocked.y) - tip(surface, side.free.x, side.free.y));
    for (int turn = 0; turn < kEdgeHalvings && apart > found; ++turn, apart *= 0.5) {
        const double middle = 0.5 * (inside + outside);
        const Vec2d at = place(middle);
        (is_clear_at(surface, at.x, at.y) ? inside : outside) = middle;
    }
    const Vec2d at = place(inside);
    return tip(surface, at.x, at.y);
}

// Between two segments the edge is searched on interpolated segments; none where the one in the
// middle starts blocked. Dropped tips would rest on top of an overhang's edge: they are for those.
std::optional<Points> OffsetCurveTrimmer::edge_points(
    int surface, const EdgeSide& from, const EdgeSide& to, Vec3d a, Vec3d b) const
{
    const Vec2d at = (from.free + to.free) * 0.5;
    if (!is_clear_at(surface, at.x, at.y)) {
        return std::nullopt;
    }
    return path_fitter_.sample(
        [&](double t) {
            return t == 0   ? a
                   : t == 1 ? b
                            : edge_tip(surface, {from.free * (1 - t) + to.free * t,
                                                 from.blocked * (1 - t) + to.blocked * t});
        },
        {0, 1}, kEdgeDeepest);
}

}  // namespace cusp::adaptive_isocurve
