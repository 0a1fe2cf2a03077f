// Interval arithmetic on the spreads of a cell's derivatives.
#include "host_tools/geometry/part_model/bend_bounds.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/enclosure.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

namespace {

struct EnclosureVector {
    Enclosure x, y, z;
};

EnclosureVector around(Vec3d p, double spread)
{
    return {
        {p.x - spread, p.x + spread}, {p.y - spread, p.y + spread}, {p.z - spread, p.z + spread}};
}

EnclosureVector cross(const EnclosureVector& a, const EnclosureVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Enclosure dot(const EnclosureVector& a, const EnclosureVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace

// Along a line of the plan with unit direction e the second derivative of the height is
//   N . (S_ss a^2 + 2 S_st a b + S_tt b^2) / N_z
// with a = e x S_t / N_z, b = S_s x e / N_z and N = S_s x S_t.
BendBounds bend_bounds(const BezierCell& cell, const BezierCell::Spread& e)
{
    const SurfacePoint& m = cell.middle();
    const EnclosureVector p = around(m.du, e.ds);
    const EnclosureVector q = around(m.dv, e.dt);
    const EnclosureVector n = cross(p, q);
    if (n.z.low <= 0.0 && n.z.high >= 0.0) {
        return kNoBendBounds;
    }
    const Enclosure inverse_z = inverse(n.z);
    const EnclosureVector unit{n.x * inverse_z, n.y * inverse_z, {1.0, 1.0}};
    const Enclosure ss = dot(unit, around(m.duu, e.dss));
    const Enclosure st = dot(unit, around(m.duv, e.dst));
    const Enclosure tt = dot(unit, around(m.dvv, e.dtt));
    const Enclosure px = p.x * inverse_z;
    const Enclosure py = p.y * inverse_z;
    const Enclosure qx = q.x * inverse_z;
    const Enclosure qy = q.y * inverse_z;
    const Enclosure xx = ss * (qy * qy) - 2.0 * (st * (qy * py)) + tt * (py * py);
    const Enclosure xy = st * (qy * px + qx * py) - ss * (qx * qy) - tt * (px * py);
    const Enclosure yy = ss * (qx * qx) - 2.0 * (st * (qx * px)) + tt * (px * px);
    const auto largest = [&](double a, double b) {
        return 0.5 * (a + b) + elementary::hypot(0.5 * (a - b), magnitude(xy));
    };
    return {elementary::hypot(magnitude(unit.x), magnitude(unit.y)),
            std::max(0.0, largest(xx.high, yy.high)), std::max(0.0, largest(-xx.low, -yy.low))};
}

void widen(BendBounds& bounds, const BendBounds& by)
{
    bounds = {std::max(bounds.slope, by.slope), std::max(bounds.up, by.up),
              std::max(bounds.down, by.down)};
}

}  // namespace cusp::part_model
