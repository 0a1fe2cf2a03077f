// Interpolates, bounds every cell, inserts knots where the bound is too large, and repeats.
#include "host_tools/geometry/part_model/offset_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/spline_basis.hpp"
#include "host_tools/geometry/part_model/offset_error.hpp"

namespace cusp::part_model {

using nurbs::BezierPatch;
using nurbs::ControlRows;
using nurbs::crease_knots;
using nurbs::Curve;
using nurbs::distinct_knots;
using nurbs::HomogeneousPoint;
using nurbs::multiplicity;
using nurbs::SplineBasis;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr int kCubic = 3;
constexpr int kMostRounds = 12;
constexpr double kLeastSpan = 1.0 / 64;  // of a span of the surface: not divided further
constexpr std::size_t kMostControlPoints = 40000;
constexpr int kSamples = 16;

Vec3d normal_at(const SurfacePoint& p, double side)
{
    const Vec3d across = cross(p.du, p.dv);
    const double length = norm(across);
    return length > 0 ? across * (side / length) : Vec3d{};
}

// First knots of the approximation in one direction: the surface's own, with multiplicities for the
// continuity of its offset.
std::vector<double> first_knots(const std::vector<double>& knots, int degree, std::size_t count)
{
    const std::vector<double> breaks = distinct_knots(knots, degree, count);
    std::vector<double> out(kCubic + 1, breaks.front());
    for (std::size_t k = 1; k + 1 < breaks.size(); ++k) {
        const int smooth = degree - static_cast<int>(multiplicity(knots, breaks[k])) - 1;
        const int times = std::clamp(kCubic - smooth, 1, kCubic);
        out.insert(out.end(), static_cast<std::size_t>(times), breaks[k]);
    }
    out.insert(out.end(), kCubic + 1, breaks.back());
    return out;
}

std::vector<double> distinct(const std::vector<double>& knots)
{
    std::vector<double> out = knots;
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<double> greville(const std::vector<double>& knots)
{
    std::vector<double> out;
    for (std::size_t k = 0; k + kCubic + 1 < knots.size(); ++k) {
        out.push_back((knots[k + 1] + knots[k + 2] + knots[k + 3]) / 3.0);
    }
    return out;
}

// The factored collocation matrix of cubics at the Greville abscissae. It is totally positive and
// banded, so elimination needs no pivoting.
class Interpolation {
public:
    explicit Interpolation(const std::vector<double>& knots)
        : places_{greville(knots)}, rows_(places_.size())
    {
        const std::size_t n = places_.size();
        for (std::size_t i = 0; i < n; ++i) {
            SplineBasis basis;
            evaluate_basis(knots, kCubic, n, places_[i], false, basis);
            for (std::size_t k = 0; k <= kCubic; ++k) {
                entry(i, basis.first + k) = basis.value[k];
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t r = i + 1; r < std::min(n, i + kBand + 1); ++r) {
                const double factor = entry(r, i) / entry(i, i);
                entry(r, i) = factor;
                for (std::size_t c = i + 1; c < std::min(n, i + kBand + 1); ++c) {
                    entry(r, c) -= factor * entry(i, c);
                }
            }
        }
    }

    const std::vector<double>& places() const { return places_; }

    // Replaces the values at the places, `stride` apart, by control points.
    void solve(Vec3d* values, std::size_t stride) const
    {
        const std::size_t n = places_.size();
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t r = i + 1; r < std::min(n, i + kBand + 1); ++r) {
                values[r * stride] = values[r * stride] - values[i * stride] * entry(r, i);
            }
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t c = i + 1; c < std::min(n, i + kBand + 1); ++c) {
                values[i * stride] = values[i * stride] - values[c * stride] * entry(i, c);
            }
            values[i * stride] = values[i * stride] / entry(i, i);
        }
    }

private:
    static constexpr std::size_t kBand = 3;
    using Row = std::array<double, 2 * kBand + 1>;

    double& entry(std::size_t row, std::size_t column) { return rows_[row][column + kBand - row]; }
    double entry(std::size_t row, std::size_t column) const
    {
        return rows_[row][column + kBand - row];
    }

    std::vector<double> places_;
    std::vector<Row> rows_;
};

// The fourth difference of five values along a cell: the deviation from a cubic.
template <class At>
double bend_of(const At& at)
{
    const Vec3d fourth = at(0.0) - at(0.25) * 4.0 + at(0.5) * 6.0 - at(0.75) * 4.0 + at(1.0);
    return norm(fourth);
}

// The part of a surface between knots, both ends clamped.
Surface between_knots(const Surface& s, std::array<double, 2> u, std::array<double, 2> v)
{
    const auto cut = [](ControlRows rows, std::array<double, 2> ends) {
        for (const double end : ends) {
            insert_to_degree(rows, end);
        }
        const auto p = static_cast<std::size_t>(rows.degree);
        const auto first = static_cast<std::size_t>(
            std::lower_bound(rows.knots.begin(), rows.knots.end(), ends[1]) - rows.knots.begin());
        const auto begin = static_cast<std::size_t>(
            std::upper_bound(rows.knots.begin(), rows.knots.end(), ends[0]) - rows.knots.begin());
        ControlRows out{rows.degree, {}, rows.width, {}};
        out.knots.assign(p + 1, ends[0]);
        out.knots.insert(out.knots.end(), rows.knots.begin() + static_cast<std::ptrdiff_t>(begin),
                         rows.knots.begin() + static_cast<std::ptrdiff_t>(first));
        out.knots.insert(out.knots.end(), p + 1, ends[1]);
        const std::size_t row = begin - p - 1;
        const std::size_t count = out.knots.size() - p - 1;
        const auto from = rows.points.begin() + static_cast<std::ptrdiff_t>(row * rows.width);
        out.points.assign(from, from + static_cast<std::ptrdiff_t>(count * rows.width));
        return out;
    };
    const auto take = [](const ControlRows& rows, std::vector<double>& knots, int& size) {
        knots = rows.knots;
        size = static_cast<int>(rows.rows());
    };
    Surface out = s;
    out.trims.clear();
    const ControlRows in_u = cut(control_rows_along_u(s), u);
    take(in_u, out.knots_u, out.size_u);
    out.points.clear();
    out.weights.clear();
    for (const HomogeneousPoint& h : in_u.points) {
        out.points.push_back({h.x / h.w, h.y / h.w, h.z / h.w});
        out.weights.push_back(h.w);
    }
    const ControlRows in_v = cut(control_rows_along_v(out), v);
    take(in_v, out.knots_v, out.size_v);
    out.points.resize(in_v.points.size());
    out.weights.resize(in_v.points.size());
    const auto nu = static_cast<std::size_t>(out.size_u);
    const auto nv = static_cast<std::size_t>(out.size_v);
    for (std::size_t j = 0; j < nv; ++j) {
        for (std::size_t i = 0; i < nu; ++i) {
            const HomogeneousPoint& h = in_v.points[j * nu + i];
            out.points[i * nv + j] = {h.x / h.w, h.y / h.w, h.z / h.w};
            out.weights[i * nv + j] = h.w;
        }
    }
    return out;
}

}  // namespace

OffsetSurface::OffsetSurface(const Surface& surface, const OffsetRequest& request)
    : source_{clamped(surface)}
{
    double up = 0;
    for (int i = 0; i < kSamples; ++i) {
        for (int j = 0; j < kSamples; ++j) {
            const SurfacePoint p = derivatives_at(
                source_,
                source_.u_begin() + (source_.u_end() - source_.u_begin()) * (i + 0.5) / kSamples,
                source_.v_begin() + (source_.v_end() - source_.v_begin()) * (j + 0.5) / kSamples);
            up += cross(p.du, p.dv).z;
        }
    }
    side_ = up < 0 ? -1 : 1;
    const std::vector<double> us =
        crease_knots(source_.knots_u, source_.degree_u, static_cast<std::size_t>(source_.size_u));
    const std::vector<double> vs =
        crease_knots(source_.knots_v, source_.degree_v, static_cast<std::size_t>(source_.size_v));
    for (std::size_t i = 1; i < us.size(); ++i) {
        for (std::size_t j = 1; j < vs.size(); ++j) {
            add_piece(between_knots(source_, {us[i - 1], us[i]}, {vs[j - 1], vs[j]}), request);
        }
    }
}

namespace {

// The approximation of one piece.
class PieceFit {
public:
    PieceFit(const Surface& part, const OffsetRequest& request, double side)
        : part_{part},
          request_{request},
          side_{side},
          own_u_{distinct(part.knots_u)},
          own_v_{distinct(part.knots_v)},
          knots_u_{first_knots(part.knots_u, part.degree_u, static_cast<std::size_t>(part.size_u))},
          knots_v_{first_knots(part.knots_v, part.degree_v, static_cast<std::size_t>(part.size_v))}
    {
    }

    void run()
    {
        for (int round = 0; round < kMostRounds; ++round) {
            interpolate();
            if (!find_bounds() || round + 1 == kMostRounds || !refine()) {
                return;
            }
        }
    }

    const Surface& surface() const { return surface_; }
    const std::vector<double>& bounds() const { return bounds_; }

private:
    Vec3d offset_at(double u, double v) const
    {
        const SurfacePoint p = derivatives_at(part_, u, v);
        return p.point + normal_at(p, side_) * request_.distance;
    }

    void interpolate()
    {
        const Interpolation along_u{knots_u_};
        const Interpolation along_v{knots_v_};
        const std::size_t nu = along_u.places().size();
        const std::size_t nv = along_v.places().size();
        std::vector<Vec3d> points;
        points.reserve(nu * nv);
        for (const double u : along_u.places()) {
            for (const double v : along_v.places()) {
                points.push_back(offset_at(u, v));
            }
        }
        for (std::size_t i = 0; i < nu; ++i) {
            along_v.solve(&points[i * nv], 1);
        }
        for (std::size_t j = 0; j < nv; ++j) {
            along_u.solve(&points[j], nv);
        }
        surface_ = {kCubic,
                    kCubic,
                    knots_u_,
                    knots_v_,
                    static_cast<int>(nu),
                    static_cast<int>(nv),
                    std::move(points),
                    {},
                    {}};
        surface_.weights.assign(surface_.points.size(), 1.0);
    }

    // Returns whether some cell exceeds the tolerance.
    bool find_bounds()
    {
        const std::vector<double> us = distinct(knots_u_);
        const std::vector<double> vs = distinct(knots_v_);
        const std::vector<BezierPatch> offsets = bezier_patches(surface_);
        const std::vector<BezierPatch> patches = patches_between(us, vs);
        bounds_.clear();
        bool over = false;
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            bounds_.push_back(offset_error_bound(patches[k].surface, offsets[k].surface,
                                                 request_.distance, side_, request_.tolerance));
            over = over || bounds_.back() > request_.tolerance;
        }
        return over;
    }

    std::vector<BezierPatch> patches_between(const std::vector<double>& us,
                                             const std::vector<double>& vs) const
    {
        std::vector<BezierPatch> out;
        // Rows first: a strip of the surface between two u, then its patches.
        for (std::size_t i = 1; i < us.size(); ++i) {
            const Surface strip =
                between_knots(part_, {us[i - 1], us[i]}, {part_.v_begin(), part_.v_end()});
            for (std::size_t j = 1; j < vs.size(); ++j) {
                out.push_back({between_knots(strip, {us[i - 1], us[i]}, {vs[j - 1], vs[j]}),
                               us[i - 1], us[i], vs[j - 1], vs[j]});
            }
        }
        return out;
    }

    // Inserts knots in the middles of spans that exceed the tolerance; false where none may be
    // divided.
    bool refine()
    {
        const std::vector<double> us = distinct(knots_u_);
        const std::vector<double> vs = distinct(knots_v_);
        std::vector<bool> split_u(us.size(), false);
        std::vector<bool> split_v(vs.size(), false);
        for (std::size_t i = 0; i + 1 < us.size(); ++i) {
            for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
                if (bounds_[i * (vs.size() - 1) + j] <= request_.tolerance) {
                    continue;
                }
                const auto [along_u, along_v] = bends(us[i], us[i + 1], vs[j], vs[j + 1]);
                const bool can_u = may_split(own_u_, us[i], us[i + 1]);
                const bool can_v = may_split(own_v_, vs[j], vs[j + 1]);
                constexpr double kAlone = 4;
                split_u[i] = split_u[i] || (can_u && (along_u * kAlone > along_v || !can_v));
                split_v[j] = split_v[j] || (can_v && (along_v * kAlone > along_u || !can_u));
            }
        }
        const bool split_any = insert_middles(knots_u_, us, split_u);
        return (insert_middles(knots_v_, vs, split_v) || split_any) &&
               knots_u_.size() * knots_v_.size() < kMostControlPoints;
    }

    std::array<double, 2> bends(double u0, double u1, double v0, double v1) const
    {
        std::array<double, 2> largest{0, 0};
        for (const double share : {0.0, 0.5, 1.0}) {
            largest[0] = std::max(largest[0], bend_of([&](double t) {
                                      return offset_at(u0 + (u1 - u0) * t, v0 + (v1 - v0) * share);
                                  }));
            largest[1] = std::max(largest[1], bend_of([&](double t) {
                                      return offset_at(u0 + (u1 - u0) * share, v0 + (v1 - v0) * t);
                                  }));
        }
        return largest;
    }

    static bool may_split(const std::vector<double>& own, double from, double to)
    {
        const auto next = std::upper_bound(own.begin(), own.end() - 1, from);
        return to - from > kLeastSpan * (*next - *(next - 1));
    }

    static bool insert_middles(std::vector<double>& knots,
                               const std::vector<double>& breaks,
                               const std::vector<bool>& split)
    {
        bool any = false;
        for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
            if (split[k]) {
                knots.push_back(0.5 * (breaks[k] + breaks[k + 1]));
                any = true;
            }
        }
        std::sort(knots.begin(), knots.end());
        return any;
    }

    const Surface& part_;
    const OffsetRequest& request_;
    double side_;
    std::vector<double> own_u_;
    std::vector<double> own_v_;
    std::vector<double> knots_u_;
    std::vector<double> knots_v_;
    Surface surface_;
    std::vector<double> bounds_;
};

}  // namespace

void OffsetSurface::add_piece(const Surface& part, const OffsetRequest& request)
{
    PieceFit fit{part, request, side_};
    fit.run();
    Piece piece{
        fit.surface(), distinct(fit.surface().knots_u), distinct(fit.surface().knots_v), {}};
    for (const double bound : fit.bounds()) {
        const bool bounded = bound <= request.tolerance;
        piece.bounded.push_back(bounded);
        ++cells_;
        without_bound_ += bounded ? 0 : 1;
        error_bound_ = bounded ? std::max(error_bound_, bound) : error_bound_;
    }
    pieces_.push_back(std::move(piece));
}

int OffsetSurface::control_points() const
{
    std::size_t sum = 0;
    for (const Piece& piece : pieces_) {
        sum += piece.surface.points.size();
    }
    return static_cast<int>(sum);
}

bool OffsetSurface::is_up(double u, double v) const
{
    const SurfacePoint p = derivatives_at(source_, u, v);
    return cross(p.du, p.dv).z * side_ > 0;
}

std::optional<Curve> OffsetSurface::isocurve(double v, double u_begin, double u_end) const
{
    for (const Piece& piece : pieces_) {
        if (u_begin < piece.u.front() || u_end > piece.u.back() || v < piece.v.front() ||
            v > piece.v.back()) {
            continue;
        }
        const auto cell_of = [](const std::vector<double>& breaks, double at) {
            const auto next = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, at);
            return static_cast<std::size_t>(next - breaks.begin()) - 1;
        };
        const std::size_t column = cell_of(piece.v, v);
        for (std::size_t i = cell_of(piece.u, u_begin); i + 1 < piece.u.size(); ++i) {
            if (piece.u[i] >= u_end) {
                break;
            }
            if (!piece.bounded[i * (piece.v.size() - 1) + column]) {
                return std::nullopt;
            }
        }
        for (int k = 0; k <= kSamples; ++k) {
            if (!is_up(u_begin + (u_end - u_begin) * k / kSamples, v)) {
                return std::nullopt;
            }
        }
        Curve curve = isocurve_at_v(piece.surface, v);
        if (u_end < curve.domain_end()) {
            curve = split_at(curve, u_end)[0];
        }
        if (u_begin > curve.domain_begin()) {
            curve = split_at(curve, u_begin)[1];
        }
        return curve;
    }
    return std::nullopt;
}

}  // namespace cusp::part_model
