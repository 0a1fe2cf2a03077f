// Quintic Hermite pieces u(s), accepted by the speed they give at Gauss points.
#include "firmware/nurbs/arc_length_table.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::nurbs {
namespace {

// Homogeneous point: weight times position, and the weight.
struct Weighted {
    AxisVecf point;
    float weight;
};

Weighted mix(const Weighted& a, const Weighted& b, float t) noexcept
{
    return {a.point + t * (b.point - a.point), a.weight + t * (b.weight - a.weight)};
}

Weighted difference(const Weighted& a, const Weighted& b) noexcept
{
    return {b.point - a.point, b.weight - a.weight};
}

// One coordinate of de Casteljau's scheme down to its last point, without a loop: all of it in
// registers. The same operations as reduce().
template <unsigned kOrder>
float last_of(const std::array<float, kOrder>& points, float u) noexcept
{
    if constexpr (kOrder == 1) {
        return points[0];
    } else {
        std::array<float, kOrder - 1> next;
#pragma GCC unroll 4
        for (unsigned i = 0; i + 1 < kOrder; ++i) {
            next[i] = points[i] + u * (points[i + 1] - points[i]);
        }
        return last_of<kOrder - 1>(next, u);
    }
}

// point_at() of one order. Weights of 1 change no bit, and are left out.
template <unsigned kOrder>
AxisVecf point_of_order(const path::BezierPiece& piece, float u) noexcept
{
    std::array<float, kOrder> weight;
    bool weighted = false;
#pragma GCC unroll 5
    for (unsigned i = 0; i < kOrder; ++i) {
        weight[i] = piece.weights[i];
        weighted = weighted || weight[i] != 1.0F;
    }
    AxisVecf point;
#pragma GCC unroll 4
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        std::array<float, kOrder> values;
#pragma GCC unroll 5
        for (unsigned i = 0; i < kOrder; ++i) {
            values[i] = weighted ? piece.points[i][axis] * weight[i] : piece.points[i][axis];
        }
        point[axis] = last_of<kOrder>(values, u);
    }
    return weighted ? point * (1.0F / last_of<kOrder>(weight, u)) : point;
}

using Net = std::array<Weighted, path::kMaxOrder>;

Net net_of(const path::BezierPiece& piece) noexcept
{
    Net net{};
    for (unsigned i = 0; i < piece.order; ++i) {
        net[i] = {piece.points[i] * piece.weights[i], piece.weights[i]};
    }
    return net;
}

// Position and derivatives by the parameter.
struct Derivatives {
    AxisVecf position;
    AxisVecf first;
    AxisVecf second;
    AxisVecf third;
};

// de Casteljau's scheme down to `points` points.
void reduce(Net& net, unsigned order, unsigned points, float u) noexcept
{
    for (unsigned size = order; size > points; --size) {
        for (unsigned i = 0; i + 1 < size; ++i) {
            net[i] = mix(net[i], net[i + 1], u);
        }
    }
}

// Quotient rule: P = A / w, P' = (A' - w' P) / w and so on.
Derivatives project(const Weighted& value,
                    const Weighted& first,
                    const Weighted& second,
                    const Weighted& third) noexcept
{
    const float scale = 1.0F / value.weight;
    Derivatives d{};
    d.position = value.point * scale;
    d.first = (first.point - first.weight * d.position) * scale;
    d.second = (second.point - 2.0F * first.weight * d.first - second.weight * d.position) * scale;
    d.third = (third.point - 3.0F * first.weight * d.second - 3.0F * second.weight * d.first -
               third.weight * d.position) *
              scale;
    return d;
}

Weighted scaled(const Weighted& a, float k) noexcept { return {a.point * k, a.weight * k}; }

Derivatives derivatives_at(const path::BezierPiece& piece, float u) noexcept
{
    Net net = net_of(piece);
    const auto degree = static_cast<float>(piece.order - 1U);
    const unsigned left = std::min<unsigned>(piece.order, 4U);
    reduce(net, piece.order, left, u);
    Weighted third{};
    Weighted second{};
    if (left == 4) {
        const Weighted a = difference(net[0], net[1]);
        const Weighted b = difference(net[1], net[2]);
        const Weighted c = difference(net[2], net[3]);
        third = scaled(difference(difference(a, b), difference(b, c)),
                       degree * (degree - 1.0F) * (degree - 2.0F));
        reduce(net, 4, 3, u);
    }
    if (left >= 3) {
        second = scaled(difference(difference(net[0], net[1]), difference(net[1], net[2])),
                        degree * (degree - 1.0F));
        reduce(net, 3, 2, u);
    }
    const Weighted first = scaled(difference(net[0], net[1]), degree);
    return project(mix(net[0], net[1], u), first, second, third);
}

// |dP/du| alone.
float speed_at(const path::BezierPiece& piece, float u) noexcept
{
    Net net = net_of(piece);
    reduce(net, piece.order, 2, u);
    const float weight = net[0].weight + u * (net[1].weight - net[0].weight);
    // With A = w P: A' - w' P = (A1 w0 - A0 w1) p / w at the last two points of the scheme.
    const AxisVecf turn = net[1].point * net[0].weight - net[0].point * net[1].weight;
    return static_cast<float>(piece.order - 1U) * norm(turn) / (weight * weight);
}

// 5-point rule of Gauss and Legendre on [0, 1].
constexpr std::array<float, 5> kGaussNode = {0.0469100770F, 0.2307653449F, 0.5F, 0.7692346551F,
                                             0.9530899230F};
constexpr std::array<float, 5> kGaussWeight = {0.1184634425F, 0.2393143352F, 0.2844444444F,
                                               0.2393143352F, 0.1184634425F};

float length_between(const path::BezierPiece& piece, float from, float to) noexcept
{
    float sum = 0;
    for (unsigned k = 0; k < kGaussNode.size(); ++k) {
        sum += kGaussWeight[k] * speed_at(piece, from + (to - from) * kGaussNode[k]);
    }
    return sum * (to - from);
}

// u(x) = a.u + x (c1 + x (c2 + ...)) with x = (s - a.s) / (b.s - a.s) in [0, 1].
struct Quintic {
    float c1, c2, c3, c4, c5;
};

inline Quintic quintic_between(const ArcLengthNode& a,
                               const ArcLengthNode& b,
                               float length) noexcept
{
    const float c1 = length * a.du;
    const float c2 = 0.5F * length * length * a.ddu;
    const float value = b.u - a.u - c1 - c2;
    const float slope = length * b.du - c1 - 2.0F * c2;
    const float bend = length * length * b.ddu - 2.0F * c2;
    return {c1, c2, 10.0F * value - 4.0F * slope + 0.5F * bend,
            -15.0F * value + 7.0F * slope - bend, 6.0F * value - 3.0F * slope + 0.5F * bend};
}

float rise(const Quintic& q, float x) noexcept
{
    return x * (q.c1 + x * (q.c2 + x * (q.c3 + x * (q.c4 + x * q.c5))));
}

float slope(const Quintic& q, float x) noexcept
{
    return q.c1 + x * (2.0F * q.c2 + x * (3.0F * q.c3 + x * (4.0F * q.c4 + x * (5.0F * q.c5))));
}

// Node at u; its s is still to be set.
bool make_node(const path::BezierPiece& piece, float u, ArcLengthNode& node) noexcept
{
    const CurveState state = state_at(piece, u);
    node.u = u;
    node.du = state.du;
    node.ddu = state.ddu;
    return state.du > 0;
}

// True if the quintic between two nodes keeps the speed. Half of kMaxSpeedError is reserved
// for errors between the sample points and for rounding.
bool keeps_speed(const path::BezierPiece& piece,
                 const ArcLengthNode& a,
                 const ArcLengthNode& b,
                 float length) noexcept
{
    constexpr float kAccepted = 0.5F * kMaxSpeedError;
    // The error and two of its derivatives vanish at both ends. Gauss points miss the places where
    // such an error is largest; these seven points do not.
    constexpr std::array<float, 7> kChecked = {0.1F, 0.24F, 0.37F, 0.5F, 0.63F, 0.76F, 0.9F};
    const Quintic q = quintic_between(a, b, length);
    for (const float x : kChecked) {
        const float u = a.u + rise(q, x);
        if (u < a.u || u > b.u) {
            return false;
        }
        const float speed = speed_at(piece, u) * slope(q, x);
        if (!(std::fabs(speed - length) <= kAccepted * length)) {
            return false;
        }
    }
    return true;
}

}  // namespace

CurveState state_at(const path::BezierPiece& piece, float u) noexcept
{
    constexpr float kStandsStill = 1e-12F;
    const Derivatives d = derivatives_at(piece, u);
    CurveState state{};
    state.position = d.position;
    const float speed = norm(d.first);
    if (!(speed > kStandsStill)) {
        return state;
    }
    // u' = 1/g, u'' = -g_u/g^3, u''' = -g_uu/g^4 + 3 g_u^2/g^5 with g = |dP/du|.
    const float u1 = 1.0F / speed;
    const AxisVecf tangent = d.first * u1;
    const float along = dot(tangent, d.second);  // g_u
    const float change =
        (dot(d.second, d.second) - along * along) * u1 + dot(tangent, d.third);  // g_uu
    const float u2 = -along * u1 * u1 * u1;
    const float u3 = (-change + 3.0F * along * along * u1) * u1 * u1 * u1 * u1;
    state.tangent = tangent;
    state.curvature = d.second * (u1 * u1) + d.first * u2;
    state.change = d.third * (u1 * u1 * u1) + d.second * (3.0F * u1 * u2) + d.first * u3;
    state.du = u1;
    state.ddu = u2;
    return state;
}

bool make_arc_length_table(const path::BezierPiece& piece, ArcLengthTable& table) noexcept
{
    // A piece that needs a step below this has a cusp.
    constexpr float kMinStep = 1.0F / 1024;
    table.size = 1;
    table.nodes[0] = {};
    if (!make_node(piece, 0, table.nodes[0])) {
        return false;
    }
    float step = 1;
    while (table.nodes[table.size - 1U].u < 1) {
        if (table.size == kMaxArcLengthNodes || step < kMinStep) {
            return false;
        }
        const ArcLengthNode& last = table.nodes[table.size - 1U];
        ArcLengthNode& node = table.nodes[table.size];
        // Steps are powers of two and begin at their multiples, so u is exact and ends at 1.
        if (!make_node(piece, last.u + step, node)) {
            step *= 0.5F;
            continue;
        }
        const float length = length_between(piece, last.u, node.u);
        if (!keeps_speed(piece, last, node, length)) {
            step *= 0.5F;
            continue;
        }
        node.s = last.s + length;
        ++table.size;
        const float doubled = node.u / (2 * step);
        if (doubled == std::floor(doubled) && node.u + 2 * step <= 1) {
            step *= 2;
        }
    }
    return true;
}

float parameter_at(const ArcLengthTable& table, float s, std::uint8_t& interval) noexcept
{
    const unsigned last = table.size - 2U;
    unsigned at = std::min<unsigned>(interval, last);
    while (at < last && s >= table.nodes[at + 1].s) {
        ++at;
    }
    while (at > 0 && s < table.nodes[at].s) {
        --at;
    }
    interval = static_cast<std::uint8_t>(at);
    const ArcLengthNode& a = table.nodes[at];
    const ArcLengthNode& b = table.nodes[at + 1];
    const float length = b.s - a.s;
    const float x = (s - a.s) / length;
    if (!(x > 0)) {
        return a.u;
    }
    if (x >= 1) {
        return b.u;
    }
    return a.u + rise(quintic_between(a, b, length), x);
}

AxisVecf point_at(const path::BezierPiece& piece, float u) noexcept
{
    if (u >= 1) {
        return piece.points[piece.order - 1U];
    }
    switch (piece.order) {
        case 2:
            return point_of_order<2>(piece, u);
        case 3:
            return point_of_order<3>(piece, u);
        case 4:
            return point_of_order<4>(piece, u);
        default:
            return point_of_order<path::kMaxOrder>(piece, u);
    }
}

}  // namespace cusp::nurbs
