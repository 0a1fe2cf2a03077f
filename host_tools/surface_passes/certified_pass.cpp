// Longest chords by doubling, then the bound of the clearance along each.
#include "host_tools/surface_passes/certified_pass.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host_tools/surface_passes/followed_ball.hpp"
#include "host_tools/surface_passes/hermite_spans.hpp"

namespace cusp::host {
namespace {

constexpr int kDeepestHalving = 12;
constexpr double kDropPiece = 3.2;      // in widths of a dip as deep as the band
constexpr int kDropHalvings = 7;        // of such a piece, where the tool may fall off
constexpr double kSampleShare = 0.08;   // of the band, for what lies between samples
constexpr double kEdgeMargin = 1.05;    // of the band
constexpr double kShortestLine = 0.01;  // mm
constexpr double kContactSlack = 5e-6;  // mm: nearer than this is the contact itself

double distance_to_chord(Vec3d p, Vec3d a, Vec3d b)
{
    const Vec3d d = b - a;
    const double square = dot(d, d);
    const double t = square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0;
    return norm(p - a - d * t);
}

bool chord_fits(const Points& points, std::size_t from, std::size_t to, double allowed)
{
    for (std::size_t k = from + 1; k < to; ++k) {
        if (distance_to_chord(points[k], points[from], points[to]) > allowed) {
            return false;
        }
    }
    return true;
}

// The last index for which `fits(index)` holds, by doubling and halving; `from` + 1 always does.
template <class Fits>
std::size_t farthest_fit(std::size_t from, std::size_t last, std::size_t guess, const Fits& fits)
{
    std::size_t good = from + 1;
    std::size_t step = std::max<std::size_t>(1, guess);
    std::size_t bad = last + 1;
    while (good < last) {
        const std::size_t next = std::min(last, good + step);
        if (!fits(next)) {
            bad = next;
            break;
        }
        good = next;
        step *= 2;
    }
    while (bad <= last && bad - good > 1) {
        const std::size_t middle = (good + bad) / 2;
        (fits(middle) ? good : bad) = middle;
    }
    return good;
}

}  // namespace

PassBand make_pass_band(double tolerance, bool one_sided)
{
    if (one_sided) {
        return {0.6 * tolerance, 0.4 * tolerance, 0};
    }
    return {0, 0.45 * tolerance, 0.5 * tolerance};
}

double length_of(const Points& points)
{
    double sum = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
        sum += norm(points[k] - points[k - 1]);
    }
    return sum;
}

CertifiedPasses::CertifiedPasses(const SurfaceModel& model, const Tool& tool, const PassBand& band)
    : model_{model}, tool_{tool}, lifted_{tool}, band_{band}
{
    lifted_.radius += band.lift;
    lifted_.corner_radius += band.lift;
}

void CertifiedPasses::guard_edges(const std::vector<Surface>& surfaces)
{
    if (band_.deepest > 0) {
        edges_.emplace(surfaces, tool_.radius, band_.deepest);
    }
}

Points CertifiedPasses::kept_off_edges(const Points& dense) const
{
    return edges_ ? edges_->kept_off(dense, kEdgeMargin * band_.band) : dense;
}

EdgeGuard::Raised CertifiedPasses::raised_off_edges(Vec3d tip) const
{
    return edges_ ? edges_->raised(tip, kEdgeMargin * band_.band)
                  : EdgeGuard::Raised{tip, std::nullopt};
}

bool CertifiedPasses::spares_edges(Vec3d a, Vec3d b) const
{
    return !edges_ || edges_->spares(a, b);
}

bool CertifiedPasses::stands_free(Vec3d tip) const
{
    // A surface's own trimmed edge is no other place, but the polyline for it is not quite the
    // edge.
    const double enough = band_.lift - std::max(kContactSlack, 2 * model_.edge_error());
    return model_.keeps_clear(tool_, tip, enough - 1e-9);
}

Contact CertifiedPasses::contact(const Foot& foot) const
{
    return model_.contact(foot.surface, foot.u, foot.v, tool_.radius + band_.lift);
}

Vec3d CertifiedPasses::tip_of(const Contact& at) const
{
    return at.centre() - Vec3d{0, 0, tool_.radius};
}

Vec3d CertifiedPasses::tip_at(int surface, double u, double v) const
{
    return tip_of(contact({surface, u, v}));
}

bool CertifiedPasses::touches_freely(int surface, double u, double v) const
{
    return touches_freely(contact({surface, u, v}));
}

bool CertifiedPasses::touches_freely(const Contact& at) const
{
    if (model_.clearance_between(at, at, tool_.radius, band_.lift - kContactSlack)) {
        return true;
    }
    return stands_free(at.centre() - Vec3d{0, 0, tool_.radius});
}

std::optional<Vec3d> CertifiedPasses::dropped(double x, double y) const
{
    const std::optional<double> z = model_.drop(lifted_, x, y);
    if (!z) {
        return std::nullopt;
    }
    return Vec3d{x, y, *z + band_.lift};
}

Points CertifiedPasses::sample(const std::function<Vec3d(double)>& at,
                               const std::vector<double>& breaks,
                               int deepest,
                               std::vector<double>* parameters) const
{
    // The middle is kept, too: what lies between is off by a quarter of this.
    const double sag = std::max(1e-5, 3 * kSampleShare * band_.band);
    Points out{at(breaks.front())};
    const auto add = [&](double parameter, Vec3d tip) {
        out.push_back(tip);
        if (parameters != nullptr) {
            parameters->push_back(parameter);
        }
    };
    if (parameters != nullptr) {
        parameters->push_back(breaks.front());
    }
    const std::function<void(double, Vec3d, double, Vec3d, int)> halve =
        [&](double from, Vec3d a, double to, Vec3d b, int depth) {
            const double middle = 0.5 * (from + to);
            const Vec3d m = at(middle);
            if (depth < deepest && norm(m - (a + b) * 0.5) > sag) {
                halve(from, a, middle, m, depth + 1);
                halve(middle, m, to, b, depth + 1);
                return;
            }
            add(middle, m);
            add(to, b);
        };
    for (std::size_t k = 1; k < breaks.size(); ++k) {
        halve(breaks[k - 1], out.back(), breaks[k], at(breaks[k]), 0);
    }
    return out;
}

Points CertifiedPasses::sample_dropped(Vec3d a, Vec3d b, Feet* feet) const
{
    FollowedBall ball{*this};
    std::map<double, Foot> foot_at;
    const auto tip = [&](double t) {
        const Vec3d p = a + (b - a) * t;
        const auto found = ball.at(p.x, p.y);
        if (feet != nullptr && found) {
            foot_at[t] = found->foot;
        }
        return found ? found->tip : Vec3d{p.x, p.y, std::min(a.z, b.z)};
    };
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double dip = std::sqrt(8 * tool_.radius * band_.band);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / (kDropPiece * dip))));
    std::vector<double> breaks;
    for (int k = 0; k <= pieces; ++k) {
        breaks.push_back(static_cast<double>(k) / pieces);
    }
    std::vector<double> parameters;
    Points out = sample(tip, breaks, kDropHalvings, feet != nullptr ? &parameters : nullptr);
    for (const double t : parameters) {
        feet->push_back(foot_at[t]);
    }
    return out;
}

bool CertifiedPasses::line_is_free(Vec3d a, Vec3d b)
{
    const double bound =
        model_.clearance_along(tool_, a, b, -band_.deepest, std::max(1e-6, 0.02 * band_.band));
    if (bound < -band_.deepest - 1e-9) {
        return false;
    }
    least_clearance_ = std::min(least_clearance_, bound);
    return true;
}

bool CertifiedPasses::rolls_freely(const Contact& a, const Contact& b)
{
    const std::optional<double> bound =
        model_.clearance_between(a, b, tool_.radius, -band_.deepest);
    if (bound) {
        least_clearance_ = std::min(least_clearance_, *bound);
    }
    return bound.has_value();
}

void CertifiedPasses::append_free_line(Vec3d a, Vec3d b, int depth, Points& out)
{
    if (line_is_free(a, b)) {
        out.push_back(b);
        return;
    }
    if (depth == 0) {
        b = lifted_free(b);
    }
    const double length = norm(b - a);
    if (length < kShortestLine || depth > kDeepestHalving) {
        // Both ends stand free; what is left between is lifted over.
        const double up = std::max(length, kShortestLine);
        const double top = std::max(a.z, b.z) + up;
        for (const Vec3d& next : {Vec3d{a.x, a.y, top}, Vec3d{b.x, b.y, top}, b}) {
            least_clearance_ = std::min(least_clearance_,
                                        model_.clearance_along(tool_, out.back(), next, 0, 1e-6));
            out.push_back(next);
        }
        return;
    }
    Vec3d middle = (a + b) * 0.5;
    if (const std::optional<Vec3d> on_model = dropped(middle.x, middle.y)) {
        middle.z = std::max(middle.z, on_model->z);
    }
    append_free_line(a, middle, depth + 1, out);
    append_free_line(middle, b, depth + 1, out);
}

Vec3d CertifiedPasses::lifted_free(Vec3d tip) const
{
    if (model_.clearance(tool_, tip, -band_.deepest + 1e-9).distance >= -band_.deepest - 1e-9) {
        return tip;
    }
    const std::optional<Vec3d> on_model = dropped(tip.x, tip.y);
    return on_model ? Vec3d{tip.x, tip.y, std::max(tip.z, on_model->z)} : tip;
}

std::size_t CertifiedPasses::chord_end(const Points& dense,
                                       std::size_t from,
                                       std::size_t guess) const
{
    const double allowed = band_.band * (1 - kSampleShare);
    return farthest_fit(from, dense.size() - 1, guess,
                        [&](std::size_t k) { return chord_fits(dense, from, k, allowed); });
}

std::optional<Points> CertifiedPasses::fit_free_lines(const Points& dense, const Feet& feet)
{
    const double least_before = least_clearance_;
    Contact last = contact(feet.front());
    Points out{tip_of(last)};
    std::size_t from = 0;
    std::size_t guess = 4;
    while (from + 1 < dense.size()) {
        const std::size_t to = chord_end(dense, from, guess);
        guess = (to - from) / 2;
        const Contact next = contact(feet[to]);
        const std::size_t middle = (from + to) / 2;
        if (!rolls_freely(last, next) &&
            !(touches_freely(last) && touches_freely(next) &&
              touches_freely(contact(feet[middle])) && line_is_free(out.back(), tip_of(next)))) {
            least_clearance_ = least_before;
            return std::nullopt;
        }
        out.push_back(tip_of(next));
        last = next;
        from = to;
    }
    return out;
}

Points CertifiedPasses::fit_lines(const Points& dense, const Feet& feet)
{
    Points out{lifted_free(dense.front())};
    const auto known = [&](std::size_t k) {
        return feet.size() == dense.size() && feet[k].surface >= 0;
    };
    std::optional<Contact> last;
    if (known(0) && out.back() == dense.front()) {
        last = contact(feet.front());
    }
    std::size_t from = 0;
    std::size_t guess = 4;
    while (from + 1 < dense.size()) {
        if (!last) {  // a contact knows its cell
            model_.forget_many_cells();
        }
        const std::size_t to = chord_end(dense, from, guess);
        guess = (to - from) / 2;
        std::optional<Contact> next;
        Vec3d end = dense[to];
        if (known(to)) {
            next = contact(feet[to]);
            end = tip_of(*next);
        }
        if (last && next && rolls_freely(*last, *next)) {
            out.push_back(end);
        } else {
            append_free_line(out.back(), end, 0, out);
        }
        last = out.back() == end ? next : std::nullopt;
        from = to;
    }
    return out;
}

bool CertifiedPasses::curve_is_free(const std::array<Vec3d, 4>& b, int depth, double& least) const
{
    const double bow =
        std::max(norm(b[1] - (b[0] * 2 + b[3]) / 3.0), norm(b[2] - (b[0] + b[3] * 2) / 3.0));
    if (bow > 0.05 * band_.band && depth < kDeepestHalving) {
        const Vec3d m0 = (b[0] + b[1]) * 0.5;
        const Vec3d m1 = (b[1] + b[2]) * 0.5;
        const Vec3d m2 = (b[2] + b[3]) * 0.5;
        const Vec3d q0 = (m0 + m1) * 0.5;
        const Vec3d q1 = (m1 + m2) * 0.5;
        const Vec3d c = (q0 + q1) * 0.5;
        return curve_is_free({b[0], m0, q0, c}, depth + 1, least) &&
               curve_is_free({c, q1, m2, b[3]}, depth + 1, least);
    }
    const double enough = bow - band_.deepest;
    const double bound =
        model_.clearance_along(tool_, b[0], b[3], enough, std::max(1e-6, 0.02 * band_.band));
    least = std::min(least, bound - bow);
    return bound >= enough - 1e-9;
}

bool CertifiedPasses::nurbs_is_free(const Curve& curve)
{
    double least = least_clearance_;
    for (const Curve& piece : bezier_pieces(curve)) {
        if (!curve_is_free({piece.points[0], piece.points[1], piece.points[2], piece.points[3]}, 0,
                           least)) {
            return false;
        }
    }
    least_clearance_ = least;
    return true;
}

std::optional<Curve> CertifiedPasses::fit_nurbs(const Points& dense)
{
    Points p{dense.front()};
    for (const Vec3d& next : dense) {
        if (norm(next - p.back()) > 1e-6) {
            p.push_back(next);
        }
    }
    if (p.size() < 2) {
        return std::nullopt;
    }
    std::vector<double> way{0};
    Points tangent;
    for (std::size_t k = 0; k < p.size(); ++k) {
        tangent.push_back(tangent_at(p, k));
        if (k > 0) {
            way.push_back(way.back() + norm(p[k] - p[k - 1]));
        }
    }
    std::vector<HermiteSpan> spans;
    const double allowed = band_.band * (1 - kSampleShare);
    double least = least_clearance_;
    for (std::size_t from = 0; from + 1 < p.size();) {
        const std::size_t to = farthest_fit(from, p.size() - 1, 8, [&](std::size_t k) {
            return hermite_span_fits(hermite_span(p, way, tangent, from, k), p, way, from, k,
                                     allowed);
        });
        spans.push_back(hermite_span(p, way, tangent, from, to));
        if (!curve_is_free(spans.back().bezier, 0, least)) {
            return std::nullopt;
        }
        from = to;
    }
    least_clearance_ = least;
    return joined(spans);
}

}  // namespace cusp::host
