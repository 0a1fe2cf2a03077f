// E is multiplied by the patch's weight, so that all bounded quantities are polynomials.
#include "host_tools/geometry/part_model/offset_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/bernstein_patch.hpp"

namespace cusp::part_model {

using nurbs::Surface;

namespace {

constexpr int kMostQuarterings = 3;

using Vector = std::array<BernsteinPatch, 3>;

BernsteinPatch dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The points of a patch times their weights, and the weights.
struct Homogeneous {
    Vector point;
    BernsteinPatch weight;
};

Homogeneous homogeneous(const Surface& s)
{
    const auto p = static_cast<std::size_t>(s.degree_u);
    const auto q = static_cast<std::size_t>(s.degree_v);
    const BernsteinPatch empty{p, q, {}};
    Homogeneous out{{empty, empty, empty}, empty};
    bool rational = false;
    for (std::size_t k = 0; k < s.points.size(); ++k) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            out.point[axis].c.push_back(s.points[k][axis] * s.weights[k]);
        }
        out.weight.c.push_back(s.weights[k]);
        rational = rational || s.weights[k] != 1.0;
    }
    if (!rational) {
        out.weight = BernsteinPatch::constant(1.0);
    }
    return out;
}

// The quantities to be bounded, over one square.
struct Terms {
    BernsteinPatch weight;
    BernsteinPatch radial;                     // (E . E - distance^2) w^2
    std::array<BernsteinPatch, 2> tangential;  // E . T, times the weight
    std::array<Vector, 2> tangent;             // T: the derivatives of the patch times w^2
    Vector difference;                         // E w
};

Terms make_terms(const Surface& patch, const Surface& offset, double distance)
{
    const Homogeneous s = homogeneous(patch);
    const Vector o = homogeneous(offset).point;
    Terms out;
    out.weight = s.weight;
    for (unsigned k = 0; k < 3; ++k) {
        out.difference[k] = o[k] * s.weight - s.point[k];
        const auto slope = [&](auto derivative) {
            return derivative(s.point[k]) * s.weight - s.point[k] * derivative(s.weight);
        };
        out.tangent[0][k] = slope(derivative_s);
        out.tangent[1][k] = slope(derivative_t);
    }
    out.radial =
        dot(out.difference, out.difference) - (distance * distance) * (s.weight * s.weight);
    out.tangential = {dot(out.difference, out.tangent[0]), dot(out.difference, out.tangent[1])};
    return out;
}

std::array<Terms, 4> quarters(const Terms& whole)
{
    std::array<Terms, 4> out;
    const auto take = [&](const BernsteinPatch& from, auto place) {
        const std::array<BernsteinPatch, 4> parts = quarters(from);
        for (std::size_t k = 0; k < 4; ++k) {
            place(out[k]) = parts[k];
        }
    };
    take(whole.weight, [](Terms& t) -> BernsteinPatch& { return t.weight; });
    take(whole.radial, [](Terms& t) -> BernsteinPatch& { return t.radial; });
    for (std::size_t d = 0; d < 2; ++d) {
        take(whole.tangential[d], [d](Terms& t) -> BernsteinPatch& { return t.tangential[d]; });
        for (unsigned k = 0; k < 3; ++k) {
            take(whole.tangent[d][k],
                 [d, k](Terms& t) -> BernsteinPatch& { return t.tangent[d][k]; });
        }
    }
    for (unsigned k = 0; k < 3; ++k) {
        take(whole.difference[k], [k](Terms& t) -> BernsteinPatch& { return t.difference[k]; });
    }
    return out;
}

Vec3d middle_of(const Vector& v)
{
    return {value_at(v[0], 0.5, 0.5), value_at(v[1], 0.5, 0.5), value_at(v[2], 0.5, 0.5)};
}

double longest(const Vector& v)
{
    double largest = 0;
    for (std::size_t k = 0; k < v[0].c.size(); ++k) {
        largest = std::max(largest, norm(Vec3d{v[0].c[k], v[1].c[k], v[2].c[k]}));
    }
    return largest;
}

// Lower bound of the component of T_u x T_v along its direction at the middle.
double least_normal(const Terms& terms, Vec3d direction)
{
    const Vector& a = terms.tangent[0];
    const Vector& b = terms.tangent[1];
    const BernsteinPatch along = direction.x * (a[1] * b[2] - a[2] * b[1]) +
                                 direction.y * (a[2] * b[0] - a[0] * b[2]) +
                                 direction.z * (a[0] * b[1] - a[1] * b[0]);
    return lower_bound(along);
}

double bound_of(const Terms& terms, double distance, double side)
{
    const double weight = lower_bound(terms.weight);
    const Vec3d across = cross(middle_of(terms.tangent[0]), middle_of(terms.tangent[1]));
    if (!(weight > 0) || !(norm(across) > 0)) {
        return kInfinite;
    }
    const Vec3d direction = across / norm(across);
    const double area = least_normal(terms, direction);
    if (!(area > 0) || dot(middle_of(terms.difference), direction) * side <= 0) {
        return kInfinite;
    }
    const double along = (magnitude_bound(terms.tangential[0]) * longest(terms.tangent[1]) +
                          magnitude_bound(terms.tangential[1]) * longest(terms.tangent[0])) /
                         (weight * area);
    const double radial = magnitude_bound(terms.radial) / (weight * weight);
    const double square = distance * distance;
    const double least = square - radial - along * along;
    if (!(least > 0)) {
        return kInfinite;  // the normal component of E could change its sign
    }
    const double across_error =
        std::max(distance - std::sqrt(least), std::sqrt(square + radial) - distance);
    return elementary::hypot(across_error, along);
}

double bound_quartered(
    const Terms& terms, double distance, double side, double sufficient, int quarterings)
{
    const double bound = bound_of(terms, distance, side);
    if (bound <= sufficient || quarterings == 0) {
        return bound;
    }
    double largest = 0;
    for (const Terms& part : quarters(terms)) {
        largest =
            std::max(largest, bound_quartered(part, distance, side, sufficient, quarterings - 1));
        if (largest > sufficient) {
            return bound;
        }
    }
    return largest;
}

}  // namespace

double offset_error_bound(
    const Surface& patch, const Surface& offset, double distance, double side, double sufficient)
{
    return bound_quartered(make_terms(patch, offset, distance), distance, side, sufficient,
                           kMostQuarterings);
}

}  // namespace cusp::part_model
