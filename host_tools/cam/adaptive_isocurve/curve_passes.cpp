// All curves are traced; then they are fitted, those with the most points first.
#include "host_tools/cam/adaptive_isocurve/curve_passes.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::adaptive_isocurve {

using finishing::length_of;
using finishing::Points;
using finishing::SurfaceOperation;
using nurbs::Curve;
using part_model::OffsetSurface;
using part_model::PartModel;

namespace {

constexpr double kShortestPiece = 1e-3;  // mm

TracedPiece part_of(const TracedPiece& piece, std::size_t first, std::size_t last)
{
    const auto from = static_cast<std::ptrdiff_t>(first);
    const auto to = static_cast<std::ptrdiff_t>(last + 1);
    TracedPiece out{{piece.points.begin() + from, piece.points.begin() + to},
                    {piece.cc_parameters.begin() + from, piece.cc_parameters.begin() + to},
                    piece.u_begin,
                    piece.u_end};
    out.u_begin = out.cc_parameters.front().u;
    out.u_end = out.cc_parameters.back().u;
    return out;
}

}  // namespace

std::size_t CurveFitter::Traced::points() const
{
    std::size_t sum = 0;
    for (const TracedPiece& piece : pieces) {
        sum += piece.points.size();
    }
    return sum;
}

CurveFitter::Traced CurveFitter::traced(const DomainCurve& curve, bool may_be_clear) const
{
    Traced found;
    const bool everywhere = work_.area().is_everything();
    if (may_be_clear && everywhere && add_whole(curve, found.out)) {
        return found;
    }
    TracedCurve traced = tracer_.trace(curve);
    found.out.whole = traced.pieces.size() == 1 && !traced.blocked &&
                      reaches_ends(curve, traced.pieces.front().points);
    found.out.blocked = traced.blocked;
    if (everywhere) {
        found.pieces = std::move(traced.pieces);
        return found;
    }
    found.out.whole = false;
    for (const TracedPiece& piece : traced.pieces) {
        for (const auto& [first, last] : work_.ranges_in_area(piece.points, piece.cc_parameters)) {
            found.pieces.push_back(part_of(piece, first, last));
        }
    }
    return found;
}

// Quick case: the tool is clear of everything else from end to end.
bool CurveFitter::add_whole(const DomainCurve& curve, CurvePasses& out) const
{
    const TracedPiece piece = tracer_.whole(curve);
    const bool along_pole = length_of(piece.points) < kShortestPiece;
    if (!along_pole) {
        std::optional<SurfaceOperation::FittedPass> pass =
            work_.fitted_clear_pass(piece.points, piece.cc_parameters);
        if (!pass) {
            return false;
        }
        out.passes.push_back(std::move(*pass));
    }
    out.whole = true;
    return true;
}

bool CurveFitter::reaches_ends(const DomainCurve& curve, const Points& piece) const
{
    constexpr double kSame = 1e-9;
    return norm(piece.front() - tracer_.tip(curve.surface, curve.u.front(), curve.v.front())) <
               kSame &&
           norm(piece.back() - tracer_.tip(curve.surface, curve.u.back(), curve.v.back())) < kSame;
}

// A pass may be of metres: other threads would wait for its end before they release cells, so it is
// fitted in several parts of the loop.
void CurveFitter::fit_pieces(const DomainCurve& curve,
                             const std::optional<OffsetSurface>& offset,
                             Traced& traced) const
{
    const PartModel::SharedQueries::Part queries{work_.model()};
    for (const TracedPiece& piece : std::exchange(traced.pieces, {})) {
        const std::optional<Curve> exact =
            offset ? tip_isocurve(*offset, curve, piece) : std::nullopt;
        traced.out.exact += exact ? 1 : 0;
        traced.out.passes.push_back(
            work_.fitted_pass(piece.points, exact, piece.cc_parameters, &queries));
    }
}

// The pass on the approximated offset, where the curve is an isocurve.
std::optional<Curve> CurveFitter::tip_isocurve(const OffsetSurface& offset,
                                               const DomainCurve& curve,
                                               const TracedPiece& piece) const
{
    const auto [low, high] = std::minmax_element(curve.v.begin(), curve.v.end());
    if (*low != *high) {
        return std::nullopt;
    }
    std::optional<Curve> tip = offset.isocurve(*low, piece.u_begin, piece.u_end);
    if (tip) {
        for (Vec3d& p : tip->points) {
            p.z -= work_.path_fitter().tool().radius;
        }
    }
    return tip;
}

std::vector<CurvePasses> CurveFitter::fitted(const std::vector<DomainCurve>& curves,
                                             std::size_t begin,
                                             std::size_t end,
                                             bool may_be_clear,
                                             const std::optional<OffsetSurface>& offset,
                                             const std::function<void()>& done) const
{
    std::vector<Traced> all(end - begin);
    parallel::for_each(all.size(), [&](std::size_t k) {
        const PartModel::SharedQueries::Part queries{work_.model()};
        all[k] = traced(curves[begin + k], may_be_clear);
    });
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return all[a].points() > all[b].points();
    });
    parallel::for_each(order.size(), [&](std::size_t k) {
        fit_pieces(curves[begin + order[k]], offset, all[order[k]]);
        done();
    });
    std::vector<CurvePasses> out;
    for (Traced& one : all) {
        out.push_back(std::move(one.out));
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
