// Control points of the cell by de Casteljau's algorithm; products of derivatives as convolutions.
#include "host_tools/cam/finishing/wall_cell.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::finishing {

namespace {

constexpr double kNoCoefficient = 1e-12;  // of the greatest: rounding, as at a pole

// Coefficients of a curve or a net: the Bernstein ones.
using Net = std::vector<double>;

constexpr std::size_t kTableDegree = 64;

std::vector<double> new_binomials(std::size_t n)
{
    std::vector<double> out{1.0};
    for (std::size_t k = 1; k <= n; ++k) {
        out.push_back(out.back() * static_cast<double>(n - k + 1) / static_cast<double>(k));
    }
    return out;
}

// Binomial coefficients of degree n.
class Binomials {
public:
    explicit Binomials(std::size_t n)
    {
        static const std::vector<std::vector<double>> kTable = [] {
            std::vector<std::vector<double>> rows;
            for (std::size_t k = 0; k <= kTableDegree; ++k) {
                rows.push_back(new_binomials(k));
            }
            return rows;
        }();
        if (n > kTableDegree) {
            own_ = new_binomials(n);
        }
        row_ = n > kTableDegree ? own_.data() : kTable[n].data();
    }
    Binomials(const Binomials&) = delete;
    Binomials& operator=(const Binomials&) = delete;

    double operator[](std::size_t k) const { return row_[k]; }

private:
    std::vector<double> own_;
    const double* row_;
};

ScaledBernstein scaled(std::size_t p, std::size_t q, Net net)
{
    const Binomials u{p};
    const Binomials v{q};
    for (std::size_t i = 0; i <= p; ++i) {
        for (std::size_t j = 0; j <= q; ++j) {
            net[i * (q + 1) + j] *= u[i] * v[j];
        }
    }
    return {p, q, std::move(net)};
}

// Adds factor * a * b.
void add_product(double factor,
                 const ScaledBernstein& a,
                 const ScaledBernstein& b,
                 ScaledBernstein& out)
{
    if (out.c.empty()) {
        out.p = a.p + b.p;
        out.q = a.q + b.q;
        out.c.assign((out.p + 1) * (out.q + 1), 0.0);
    }
    for (std::size_t i = 0; i <= a.p; ++i) {
        for (std::size_t j = 0; j <= a.q; ++j) {
            const double by = factor * a.c[i * (a.q + 1) + j];
            for (std::size_t k = 0; by != 0 && k <= b.p; ++k) {
                double* const to = &out.c[(i + k) * (out.q + 1) + j];
                const double* const from = &b.c[k * (b.q + 1)];
                for (std::size_t m = 0; m <= b.q; ++m) {
                    to[m] += by * from[m];
                }
            }
        }
    }
}

// a * b - c * d
ScaledBernstein difference(const ScaledBernstein& a,
                           const ScaledBernstein& b,
                           const ScaledBernstein& c,
                           const ScaledBernstein& d)
{
    ScaledBernstein out;
    add_product(1, a, b, out);
    add_product(-1, c, d, out);
    return out;
}

// The derivative of a net by s, and by t.
ScaledBernstein slope_s(std::size_t p, std::size_t q, const Net& net)
{
    if (p == 0) {
        return scaled(0, q, Net(q + 1, 0.0));
    }
    Net out;
    out.reserve(p * (q + 1));
    for (std::size_t k = 0; k < p * (q + 1); ++k) {
        out.push_back(static_cast<double>(p) * (net[k + q + 1] - net[k]));
    }
    return scaled(p - 1, q, std::move(out));
}

ScaledBernstein slope_t(std::size_t p, std::size_t q, const Net& net)
{
    if (q == 0) {
        return scaled(p, 0, Net(p + 1, 0.0));
    }
    Net out;
    out.reserve((p + 1) * q);
    for (std::size_t i = 0; i <= p; ++i) {
        for (std::size_t j = 0; j < q; ++j) {
            const std::size_t k = i * (q + 1) + j;
            out.push_back(static_cast<double>(q) * (net[k + 1] - net[k]));
        }
    }
    return scaled(p, q - 1, std::move(out));
}

double magnitude(std::array<double, 2> range) { return std::max(-range[0], range[1]); }

struct Weighted {
    Vec3d point;  // times the weight
    double weight;

    Weighted to(const Weighted& other, double share) const
    {
        return {point + (other.point - point) * share, weight + (other.weight - weight) * share};
    }
};

// Restricts rows of control points, `stride` apart, to a part of their unit interval.
void restrict_row(Weighted* row, std::size_t count, std::size_t stride, double from, double to)
{
    for (std::size_t level = count - 1; to < 1 && level > 0; --level) {
        for (std::size_t k = count - 1; k >= count - level; --k) {
            row[k * stride] = row[(k - 1) * stride].to(row[k * stride], to);
        }
    }
    const double first = to > 0 ? from / to : 0;
    for (std::size_t level = 1; first > 0 && level < count; ++level) {
        for (std::size_t k = 0; k + level < count; ++k) {
            row[k * stride] = row[k * stride].to(row[(k + 1) * stride], first);
        }
    }
}

// At a pole the first or last coefficients of a normal are none: a factor that all its components have
// in common, and that is nowhere negative.
void drop_common_factors(std::array<ScaledBernstein, 3>& normal)
{
    double most = 0;
    for (const ScaledBernstein& n : normal) {
        for (const double c : n.c) {
            most = std::max(most, std::abs(c));
        }
    }
    const auto none = [&](bool along_s, std::size_t at) {
        const std::size_t q = normal[0].q;
        const std::size_t count = along_s ? q + 1 : normal[0].p + 1;
        for (const ScaledBernstein& n : normal) {
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t index = along_s ? at * (q + 1) + k : k * (q + 1) + at;
                if (std::abs(n.c[index]) > kNoCoefficient * most) {
                    return false;
                }
            }
        }
        return true;
    };
    const auto drop = [&](bool along_s, std::size_t at) {
        for (ScaledBernstein& n : normal) {
            ScaledBernstein out{n.p - (along_s ? 1 : 0), n.q - (along_s ? 0 : 1), {}};
            for (std::size_t i = 0; i <= n.p; ++i) {
                for (std::size_t j = 0; j <= n.q; ++j) {
                    if ((along_s ? i : j) != at) {
                        out.c.push_back(n.c[i * (n.q + 1) + j]);
                    }
                }
            }
            n = std::move(out);
        }
    };
    for (const bool along_s : {true, false}) {
        const auto degree = [&] {
            return along_s ? normal[0].p : normal[0].q;
        };
        while (degree() > 0 && none(along_s, 0)) {
            drop(along_s, 0);
        }
        while (degree() > 0 && none(along_s, degree())) {
            drop(along_s, degree());
        }
    }
}

}  // namespace

std::array<double, 2> ScaledBernstein::range() const
{
    const Binomials u{p};
    const Binomials v{q};
    std::array<double, 2> out{kInfinite, -kInfinite};
    for (std::size_t i = 0; i <= p; ++i) {
        for (std::size_t j = 0; j <= q; ++j) {
            const double value = c[i * (q + 1) + j] / (u[i] * v[j]);
            out = {std::min(out[0], value), std::max(out[1], value)};
        }
    }
    return out;
}

WallCell::WallCell(const nurbs::BezierPatch& patch, Vec2d low, Vec2d high)
    : p_{static_cast<std::size_t>(patch.surface.degree_u)},
      q_{static_cast<std::size_t>(patch.surface.degree_v)},
      rational_{false}
{
    const nurbs::Surface& s = patch.surface;
    std::vector<Weighted> net;
    net.reserve(s.points.size());
    for (std::size_t k = 0; k < s.points.size(); ++k) {
        net.push_back({s.points[k] * s.weights[k], s.weights[k]});
        rational_ = rational_ || s.weights[k] != s.weights.front();
    }
    const double long_u = patch.u_end - patch.u_begin;
    const double long_v = patch.v_end - patch.v_begin;
    for (std::size_t j = 0; j <= q_; ++j) {
        restrict_row(&net[j], p_ + 1, q_ + 1, (low.x - patch.u_begin) / long_u,
                     (high.x - patch.u_begin) / long_u);
    }
    for (std::size_t i = 0; i <= p_; ++i) {
        restrict_row(&net[i * (q_ + 1)], q_ + 1, 1, (low.y - patch.v_begin) / long_v,
                     (high.y - patch.v_begin) / long_v);
    }
    const Weighted& centre = net[(p_ / 2) * (q_ + 1) + q_ / 2];
    origin_ = centre.point / centre.weight;
    std::array<Net, 4> nets;  // times the weight, and the weight
    for (Net& some : nets) {
        some.reserve(net.size());
    }
    points_.reserve(net.size());
    weights_.reserve(net.size());
    for (const Weighted& at : net) {
        points_.push_back(at.point / at.weight - origin_);
        weights_.push_back(at.weight);
        const Vec3d p = points_.back() * (rational_ ? at.weight : 1);
        nets[0].push_back(p.x);
        nets[1].push_back(p.y);
        nets[2].push_back(p.z);
        nets[3].push_back(at.weight);
    }
    normal_ = normal_of(nets);
    drop_common_factors(normal_);
}

// The numerator of the normal.
//
// nets  of points times their weights, and of these
WallCell::Vector WallCell::normal_of(std::array<std::vector<double>, 4>& nets) const
{
    Vector out;
    Vector along_s;
    Vector along_t;
    for (std::size_t k = 0; k < 3; ++k) {
        along_s[k] = slope_s(p_, q_, nets[k]);
        along_t[k] = slope_t(p_, q_, nets[k]);
    }
    if (rational_) {
        const ScaledBernstein weight_s = slope_s(p_, q_, nets[3]);
        const ScaledBernstein weight_t = slope_t(p_, q_, nets[3]);
        const ScaledBernstein weight = scaled(p_, q_, std::move(nets[3]));
        for (std::size_t k = 0; k < 3; ++k) {
            const ScaledBernstein value = scaled(p_, q_, std::move(nets[k]));
            along_s[k] = difference(along_s[k], weight, value, weight_s);
            along_t[k] = difference(along_t[k], weight, value, weight_t);
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3;
        const std::size_t b = (k + 2) % 3;
        out[k] = difference(along_s[a], along_t[b], along_s[b], along_t[a]);
    }
    return out;
}

bool WallCell::leans_more_than(double z) const
{
    const auto [low, high] = normal_[2].range();
    const double least = std::max(low, -high);
    if (!(least > 0)) {
        return false;
    }
    const double level =
        elementary::hypot(magnitude(normal_[0].range()), magnitude(normal_[1].range()));
    return least > z * elementary::hypot(level, least);
}

std::array<double, 2> WallCell::along(Vec3d from, Vec3d way) const
{
    std::array<double, 2> out{kInfinite, -kInfinite};
    for (const Vec3d& p : points_) {
        const double at = dot(p, way);
        out = {std::min(out[0], at), std::max(out[1], at)};
    }
    const double beside = dot(origin_ - from, way);
    return {out[0] + beside, out[1] + beside};
}

ScaledBernstein WallCell::normal_along(Vec3d way) const
{
    ScaledBernstein out = normal_[0];
    for (std::size_t k = 0; k < out.c.size(); ++k) {
        out.c[k] = way.x * normal_[0].c[k] + way.y * normal_[1].c[k] + way.z * normal_[2].c[k];
    }
    return out;
}

// Normals are compared where they meet the plane at distance 1 along the facet's normal. Their lengths
// up to there differ in the second order.
std::optional<WallCell::Turn> WallCell::turn(const Frame& frame,
                                             const Lines& lines,
                                             double side) const
{
    const ScaledBernstein out = normal_along(frame.normal * side);
    const double least = out.range()[0];
    if (!(least > 0)) {
        return std::nullopt;
    }
    const ScaledBernstein level = normal_along(frame.along * side);
    const Vec3d upward = cross(frame.normal, frame.along);
    const ScaledBernstein rise = normal_along(upward * side);
    Net places;
    Net weights;
    Net expected;
    const double beside = dot(origin_ - frame.middle, frame.along);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const double weight = rational_ ? weights_[k] : 1;
        weights.push_back(weight);
        places.push_back(weight * (dot(points_[k], frame.along) + beside));
    }
    for (const double s : {0.0, 1.0}) {
        for (const double t : {0.0, 1.0}) {
            expected.push_back(side * (lines.low + lines.slope.x * s + lines.slope.y * t) -
                               frame.normal.z);
        }
    }
    ScaledBernstein off;
    add_product(1, level, scaled(p_, q_, weights), off);
    add_product(-frame.bend, out, scaled(p_, q_, std::move(places)), off);
    // z of a normal over its component along the facet's, less what is expected.
    ScaledBernstein z_off;
    add_product(1, out, scaled(1, 1, std::move(expected)), z_off);
    add_product(-upward.z, rise, scaled(1, 1, Net(4, 1.0)), z_off);
    const double lowest = *std::min_element(weights.begin(), weights.end());
    Turn found{magnitude(off.range()) / (least * lowest), magnitude(rise.range()) / least,
               magnitude(level.range()) / least, magnitude(z_off.range()) / least};
    const double longer =
        0.5 * (found.along * (2 * found.most + found.along) + found.rise * found.rise);
    found.along += (found.most + found.along) * longer;
    // A unit normal's z is less than that, by half the square of what it turns.
    const double most_z = std::abs(frame.normal.z) + upward.z * found.rise;
    found.lines += 0.5 * most_z * (found.most * found.most + found.rise * found.rise);
    return found;
}

namespace {

// The greatest of a net of vectors, times their weights, and of the weights.
struct Most {
    double point{};
    double weight{};

    void include(const Weighted& at, double factor)
    {
        point = std::max(point, factor * norm(at.point));
        weight = std::max(weight, factor * std::abs(at.weight));
    }
};

Weighted minus(const Weighted& a, const Weighted& b)
{
    return {a.point - b.point, a.weight - b.weight};
}

}  // namespace

// Bound of a quotient, by the bounds of its parts.
WallCell::Bends WallCell::bends(const Frame& frame) const
{
    std::vector<Weighted> net;
    double far = 0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const Vec3d seen{dot(points_[k], frame.along), 0, points_[k].z};
        far = std::max(far, norm(seen));
        const double weight = rational_ ? weights_[k] : 1;
        net.push_back({seen * weight, weight});
    }
    const auto step_s = [&](std::size_t i, std::size_t j) {
        return minus(net[(i + 1) * (q_ + 1) + j], net[i * (q_ + 1) + j]);
    };
    const auto step_t = [&](std::size_t i, std::size_t j) {
        return minus(net[i * (q_ + 1) + j + 1], net[i * (q_ + 1) + j]);
    };
    const auto n = static_cast<double>(p_);
    const auto m = static_cast<double>(q_);
    Most s, t, ss, st, tt;
    for (std::size_t i = 0; i <= p_; ++i) {
        for (std::size_t j = 0; j <= q_; ++j) {
            if (i < p_) {
                s.include(step_s(i, j), n);
            }
            if (j < q_) {
                t.include(step_t(i, j), m);
            }
            if (i + 1 < p_) {
                ss.include(minus(step_s(i + 1, j), step_s(i, j)), n * (n - 1));
            }
            if (j + 1 < q_) {
                tt.include(minus(step_t(i, j + 1), step_t(i, j)), m * (m - 1));
            }
            if (i < p_ && j < q_) {
                st.include(minus(step_s(i, j + 1), step_s(i, j)), n * m);
            }
        }
    }
    double least = 1;
    if (rational_) {
        least = *std::min_element(weights_.begin(), weights_.end());
    }
    const double by_s = (s.point + far * s.weight) / least;
    const double by_t = (t.point + far * t.weight) / least;
    return {(ss.point + 2 * by_s * s.weight + far * ss.weight) / least,
            (st.point + by_s * t.weight + by_t * s.weight + far * st.weight) / least,
            (tt.point + 2 * by_t * t.weight + far * tt.weight) / least};
}

}  // namespace cusp::finishing
