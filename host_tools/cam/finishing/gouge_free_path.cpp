// Longest fitting chords by doubling, then the bound of the clearance along each.
#include "host_tools/cam/finishing/gouge_free_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/hermite_spans.hpp"

namespace cusp::finishing {

using nurbs::Curve;
using nurbs::Surface;
using part_model::CcPoint;
using part_model::EdgeGougeCheck;
using part_model::PartModel;
using toolpath::Tool;

namespace {

constexpr int kDeepestHalving = 12;
constexpr double kDropPiece = 3.2;      // in widths of a dip as deep as the band
constexpr int kLinesOfPart = 64;        // at least
constexpr int kDropHalvings = 7;        // of such a piece: dropped tips may jump
constexpr double kSampleShare = 0.08;   // of the band: deviation between samples
constexpr double kEdgeMargin = 1.05;    // of the band
constexpr double kShortestLine = 0.01;  // mm
constexpr double kContactSlack = 5e-6;  // mm: rounding of the contact itself
constexpr double kDepthless = 1e-6;     // mm

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

ToleranceBand make_tolerance_band(double tolerance, bool one_sided)
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

GougeFreePathFitter::GougeFreePathFitter(const PartModel& model,
                                         const Tool& tool,
                                         const ToleranceBand& band)
    : model_{model},
      tool_{tool},
      offset_tool_{tool},
      band_{band},
      area_{std::make_shared<FinishArea>()}
{
    offset_tool_.radius += band.offset;
    offset_tool_.corner_radius += band.offset;
}

void GougeFreePathFitter::check_edge_gouges(const std::vector<Surface>& surfaces)
{
    if (band_.max_gouge > 0) {
        edges_ = std::make_shared<EdgeGougeCheck>(surfaces, tool_.radius, band_.max_gouge);
    }
}

void GougeFreePathFitter::include_moves_with(double least_clearance)
{
    least_clearance_ = std::min(least_clearance_, least_clearance);
}

Points GougeFreePathFitter::moved_clear_of_edges(const Points& dense) const
{
    return edges_ ? edges_->moved_clear(dense, kEdgeMargin * band_.half_width) : dense;
}

EdgeGougeCheck::RaisedTip GougeFreePathFitter::raised_clear_of_edges(Vec3d tip) const
{
    return edges_ ? edges_->raised_clear(tip, kEdgeMargin * band_.half_width)
                  : EdgeGougeCheck::RaisedTip{tip, std::nullopt};
}

bool GougeFreePathFitter::clears_edges(Vec3d a, Vec3d b) const
{
    return !edges_ || edges_->clears(a, b);
}

double GougeFreePathFitter::least_allowed() const
{
    return tool_.corner_radius > 0 ? -band_.max_gouge : std::max(kDepthless, -band_.max_gouge);
}

bool GougeFreePathFitter::is_clear(Vec3d tip) const
{
    // The contact may lie on a trimmed edge, whose polyline deviates from it by edge_error().
    const double sufficient = band_.offset - std::max(kContactSlack, 2 * model_.edge_error());
    return model_.is_distance_at_least(tool_, tip, sufficient - 1e-9);
}

CcPoint GougeFreePathFitter::cc_point(const CcParameters& cc) const
{
    return model_.cc_point(cc.surface, cc.u, cc.v, tool_.radius + band_.offset);
}

Vec3d GougeFreePathFitter::tip_of(const CcPoint& at) const
{
    return at.centre() - Vec3d{0, 0, tool_.radius};
}

Vec3d GougeFreePathFitter::tip_at(int surface, double u, double v) const
{
    return tip_of(cc_point({surface, u, v}));
}

bool GougeFreePathFitter::is_clear_at_contact(int surface, double u, double v) const
{
    return is_clear_at_contact(cc_point({surface, u, v}));
}

bool GougeFreePathFitter::is_clear_at_contact(const CcPoint& at) const
{
    if (model_.move_clearance_between_contacts(at, at, tool_.radius,
                                               band_.offset - kContactSlack)) {
        return true;
    }
    return is_clear(at.centre() - Vec3d{0, 0, tool_.radius});
}

std::optional<Vec3d> GougeFreePathFitter::drop(double x, double y) const
{
    const std::optional<double> z = model_.drop_height(offset_tool_, x, y);
    if (!z) {
        return std::nullopt;
    }
    return Vec3d{x, y, *z + band_.offset};
}

Points GougeFreePathFitter::sample(const std::function<Vec3d(double)>& at,
                                   const std::vector<double>& breaks,
                                   int deepest,
                                   std::vector<double>* parameters) const
{
    // The middle is kept as well, so the deviation between points is a quarter of this.
    const double sag = std::max(1e-5, 3 * kSampleShare * band_.half_width);
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

Points GougeFreePathFitter::sample_dropped(Vec3d a, Vec3d b, CcParameterList* cc_parameters) const
{
    ContactTracker tool{*this};
    std::map<double, CcParameters> contact_at;
    const auto tip = [&](double t) {
        const Vec3d p = a + (b - a) * t;
        const auto found = tool.at(p.x, p.y);
        if (cc_parameters != nullptr && found) {
            contact_at[t] = found->contact;
        }
        return found ? found->tip : Vec3d{p.x, p.y, std::min(a.z, b.z)};
    };
    const double length = elementary::hypot(b.x - a.x, b.y - a.y);
    const double round = tool_.corner_radius > 0 ? tool_.corner_radius : tool_.radius;
    const double dip = std::sqrt(8 * round * band_.half_width);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / (kDropPiece * dip))));
    std::vector<double> breaks;
    for (int k = 0; k <= pieces; ++k) {
        breaks.push_back(static_cast<double>(k) / pieces);
    }
    std::vector<double> parameters;
    Points out =
        sample(tip, breaks, kDropHalvings, cc_parameters != nullptr ? &parameters : nullptr);
    for (const double t : parameters) {
        cc_parameters->push_back(contact_at[t]);
    }
    return out;
}

bool GougeFreePathFitter::is_line_clear(Vec3d a, Vec3d b)
{
    const double bound = model_.move_clearance(tool_, a, b, least_allowed(),
                                               std::max(1e-6, 0.02 * band_.half_width));
    if (bound < least_allowed() - 1e-9) {
        return false;
    }
    least_clearance_ = std::min(least_clearance_, bound);
    return true;
}

bool GougeFreePathFitter::is_move_between_contacts_clear(const CcPoint& a, const CcPoint& b)
{
    const std::optional<double> bound =
        model_.move_clearance_between_contacts(a, b, tool_.radius, -band_.max_gouge);
    if (bound) {
        least_clearance_ = std::min(least_clearance_, *bound);
    }
    return bound.has_value();
}

void GougeFreePathFitter::append_clear_line(Vec3d a, Vec3d b, int depth, Points& out)
{
    if (is_line_clear(a, b)) {
        out.push_back(b);
        return;
    }
    if (depth == 0) {
        b = raised_clear(b);
    }
    const double length = norm(b - a);
    if (length < kShortestLine || depth > kDeepestHalving) {
        // Both ends are clear: the tool is raised over the part between.
        const double up = std::max(length, kShortestLine);
        const double top = std::max(a.z, b.z) + up;
        for (const Vec3d& next : {Vec3d{a.x, a.y, top}, Vec3d{b.x, b.y, top}, b}) {
            least_clearance_ = std::min(
                least_clearance_, model_.move_clearance(tool_, out.back(), next,
                                                        std::max(0.0, least_allowed()), 1e-6));
            out.push_back(next);
        }
        return;
    }
    Vec3d middle = (a + b) * 0.5;
    if (const std::optional<Vec3d> on_model = drop(middle.x, middle.y)) {
        middle.z = std::max(middle.z, on_model->z);
    }
    append_clear_line(a, middle, depth + 1, out);
    append_clear_line(middle, b, depth + 1, out);
}

Vec3d GougeFreePathFitter::raised_clear(Vec3d tip) const
{
    if (model_.distance(tool_, tip, least_allowed() + 1e-9).distance >= least_allowed() - 1e-9) {
        return tip;
    }
    const std::optional<Vec3d> on_model = drop(tip.x, tip.y);
    return on_model ? Vec3d{tip.x, tip.y, std::max(tip.z, on_model->z)} : tip;
}

std::size_t GougeFreePathFitter::chord_end(const Points& dense,
                                           std::size_t from,
                                           std::size_t guess) const
{
    const double allowed = band_.half_width * (1 - kSampleShare);
    return farthest_fit(from, dense.size() - 1, guess,
                        [&](std::size_t k) { return chord_fits(dense, from, k, allowed); });
}

std::optional<Points> GougeFreePathFitter::fit_clear_lines(const Points& dense,
                                                           const CcParameterList& cc_parameters)
{
    const double least_before = least_clearance_;
    CcPoint last = cc_point(cc_parameters.front());
    Points out{tip_of(last)};
    std::size_t from = 0;
    std::size_t guess = 4;
    while (from + 1 < dense.size()) {
        const std::size_t to = chord_end(dense, from, guess);
        guess = (to - from) / 2;
        const CcPoint next = cc_point(cc_parameters[to]);
        const std::size_t middle = (from + to) / 2;
        if (!is_move_between_contacts_clear(last, next) &&
            !(is_clear_at_contact(last) && is_clear_at_contact(next) &&
              is_clear_at_contact(cc_point(cc_parameters[middle])) &&
              is_line_clear(out.back(), tip_of(next)))) {
            least_clearance_ = least_before;
            return std::nullopt;
        }
        out.push_back(tip_of(next));
        last = next;
        from = to;
    }
    return out;
}

Points GougeFreePathFitter::fit_lines(const Points& dense, const CcParameterList& cc_parameters)
{
    Points out{raised_clear(dense.front())};
    const auto known = [&](std::size_t k) {
        return cc_parameters.size() == dense.size() && cc_parameters[k].surface >= 0;
    };
    std::optional<CcPoint> last;
    if (known(0) && out.back() == dense.front()) {
        last = cc_point(cc_parameters.front());
    }
    std::size_t from = 0;
    std::size_t guess = 4;
    int lines = 0;
    while (from + 1 < dense.size()) {
        ++lines;
        if (!last) {  // the model caches the cells of the last contacts
            if (queries_ != nullptr && lines >= kLinesOfPart) {
                queries_->next();
                lines = 0;
            }
            model_.forget_many_cells();
        }
        const std::size_t to = chord_end(dense, from, guess);
        guess = (to - from) / 2;
        std::optional<CcPoint> next;
        Vec3d end = dense[to];
        if (known(to)) {
            next = cc_point(cc_parameters[to]);
            end = tip_of(*next);
        }
        if (last && next && is_move_between_contacts_clear(*last, *next)) {
            out.push_back(end);
        } else {
            append_clear_line(out.back(), end, 0, out);
        }
        last = out.back() == end ? next : std::nullopt;
        from = to;
    }
    return out;
}

bool GougeFreePathFitter::is_curve_clear(const std::array<Vec3d, 4>& b,
                                         int depth,
                                         double& least) const
{
    const double bow =
        std::max(norm(b[1] - (b[0] * 2 + b[3]) / 3.0), norm(b[2] - (b[0] + b[3] * 2) / 3.0));
    if (bow > 0.05 * band_.half_width && depth < kDeepestHalving) {
        const Vec3d m0 = (b[0] + b[1]) * 0.5;
        const Vec3d m1 = (b[1] + b[2]) * 0.5;
        const Vec3d m2 = (b[2] + b[3]) * 0.5;
        const Vec3d q0 = (m0 + m1) * 0.5;
        const Vec3d q1 = (m1 + m2) * 0.5;
        const Vec3d c = (q0 + q1) * 0.5;
        return is_curve_clear({b[0], m0, q0, c}, depth + 1, least) &&
               is_curve_clear({c, q1, m2, b[3]}, depth + 1, least);
    }
    const double sufficient = bow + least_allowed();
    const double bound = model_.move_clearance(tool_, b[0], b[3], sufficient,
                                               std::max(1e-6, 0.02 * band_.half_width));
    least = std::min(least, bound - bow);
    return bound >= sufficient - 1e-9;
}

bool GougeFreePathFitter::is_nurbs_clear(const Curve& curve)
{
    double least = least_clearance_;
    for (const Curve& piece : bezier_pieces(curve)) {
        if (!is_curve_clear({piece.points[0], piece.points[1], piece.points[2], piece.points[3]}, 0,
                            least)) {
            return false;
        }
    }
    least_clearance_ = least;
    return true;
}

std::optional<Curve> GougeFreePathFitter::fit_nurbs(const Points& dense)
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
    const double allowed = band_.half_width * (1 - kSampleShare);
    double least = least_clearance_;
    for (std::size_t from = 0; from + 1 < p.size();) {
        const std::size_t to = farthest_fit(from, p.size() - 1, 8, [&](std::size_t k) {
            return hermite_span_fits(hermite_span(p, way, tangent, from, k), p, way, from, k,
                                     allowed);
        });
        spans.push_back(hermite_span(p, way, tangent, from, to));
        if (!is_curve_clear(spans.back().bezier, 0, least)) {
            return std::nullopt;
        }
        from = to;
    }
    least_clearance_ = least;
    return joined(spans);
}

}  // namespace cusp::finishing
