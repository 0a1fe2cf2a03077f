// Curved vertical walls on the border of a plate, as trimmed surfaces and as the mesh that the judge
// looks at, from a seed: cylinders, arched sheets with windows, barrels and flutes that hardly bulge.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "tests/generators/faces_of_mesh.hpp"
#include "tests/generators/random_polyhedra.hpp"

namespace cusp::test {

constexpr double kChord = 3e-4;  // mm: the mesh of a curved face off it

struct WalledPart {
    Triangles mesh;
    std::vector<nurbs::Surface> faces;
};

// A curved wall: degree 2 round its axis in rational quarters or less, its radius by z of degree 2.
struct RoundWall {
    Vec2d middle;
    std::vector<double> turns;     // ends of its arcs, radians
    double low, high;              // z
    std::array<double, 3> radius;  // control points over z

    nurbs::Surface surface() const
    {
        nurbs::Surface s;
        s.degree_u = s.degree_v = 2;
        s.knots_u = {0, 0, 0};
        s.knots_v = {0, 0, 0, 1, 1, 1};
        s.size_v = 3;
        const auto add = [&](double turn, double out, double weight) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double r = radius[k] * out;
                s.points.push_back({middle.x + r * std::cos(turn), middle.y + r * std::sin(turn),
                                    low + (high - low) * 0.5 * static_cast<double>(k)});
                s.weights.push_back(weight);
            }
        };
        add(turns.front(), 1, 1);
        for (std::size_t k = 1; k < turns.size(); ++k) {
            const double half = 0.5 * (turns[k] - turns[k - 1]);
            add(turns[k] - half, 1 / std::cos(half), std::cos(half));
            add(turns[k], 1, 1);
            const auto knot = static_cast<double>(k);
            s.knots_u.insert(s.knots_u.end(), k + 1 < turns.size() ? 2 : 3, knot);
        }
        s.size_u = static_cast<int>(2 * turns.size()) - 1;
        return s;
    }
    double most_radius() const { return *std::max_element(radius.begin(), radius.end()); }
};

// The rectangle of the domain as facets within kChord of the surface.
inline void add_facets(
    Triangles& out, const nurbs::Surface& s, Vec2d low, Vec2d high, double radius)
{
    const double arc = 2 * std::sqrt(2 * kChord / radius);  // radians
    const int us = 1 + static_cast<int>((high.x - low.x) * 0.5 * kPi / arc);
    const int vs = 6;
    const auto at = [&](int i, int j) {
        return nurbs::point_at(s, low.x + (high.x - low.x) * i / us,
                               low.y + (high.y - low.y) * j / vs);
    };
    for (int i = 0; i < us; ++i) {
        for (int j = 0; j < vs; ++j) {
            add_quad(out, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
}

// A lid of a full round wall at its upper end: a plane within a circle.
inline void add_lid(WalledPart& part, const RoundWall& wall, const nurbs::Surface& side)
{
    const double r = wall.radius.back();
    const Vec3d corner{wall.middle.x - r, wall.middle.y - r, wall.high};
    nurbs::Surface lid = plane_face({corner, corner + Vec3d{2 * r, 0, 0},
                                     corner + Vec3d{2 * r, 2 * r, 0}, corner + Vec3d{0, 2 * r, 0}},
                                    {0, 0, 1});
    nurbs::Curve circle{2, side.knots_u, {}, {}};
    for (int k = 0; k < side.size_u; ++k) {
        const auto last = static_cast<std::size_t>(k * side.size_v + side.size_v - 1);
        const Vec3d p = side.points[last] - corner;
        circle.points.push_back({p.x, p.y, 0});
        circle.weights.push_back(side.weights[last]);
    }
    lid.trims = {{circle}};
    part.faces.push_back(lid);
    const int sides = 1 + static_cast<int>(kPi / std::sqrt(2 * kChord / r));
    const auto at = [&](int k) {
        const double turn = 2 * kPi * k / sides;
        return Vec3d{wall.middle.x + r * std::cos(turn), wall.middle.y + r * std::sin(turn),
                     wall.high};
    };
    for (int k = 2; k < sides; ++k) {
        part.mesh.push_back({at(0), at(k - 1), at(k)});
    }
}

inline void add_round_wall(Random& random, WalledPart& part, Vec2d middle)
{
    const double radius = uniform(random, 0.3, 3.0);
    const double low = uniform(random, -3.0, 0.0);
    const double high = uniform(random, 0.5, 5.0);
    // Exactly vertical, or so that it leans by less than any scallop; a bulge turns its normals both
    // ways.
    const auto lean = [&] {
        return whole(random, 0, 1) == 0 ? 0.0
                                        : radius * std::pow(10.0, uniform(random, -6.0, -3.5));
    };
    const RoundWall full{middle,
                         {0, 0.5 * kPi, kPi, 1.5 * kPi, 2 * kPi},
                         low,
                         high,
                         {radius, radius + lean(), radius - lean()}};
    if (whole(random, 0, 1) == 0) {
        const nurbs::Surface side = full.surface();
        part.faces.push_back(side);
        add_facets(part.mesh, side, {0, 0}, {4, 1}, full.most_radius());
        add_lid(part, full, side);
        return;
    }
    // An arched sheet with a window, or with a slot down from its upper end.
    RoundWall arch = full;
    const double from = uniform(random, 0.0, 2 * kPi);
    const double wide = uniform(random, 0.2, 0.5) * kPi;
    arch.turns = {from, from + wide, from + 2 * wide};
    nurbs::Surface sheet = arch.surface();
    const double left = uniform(random, 0.2, 0.9);
    const double right = uniform(random, left + 0.1, 1.8);
    const double sill = uniform(random, 0.1, 0.6);
    const bool slot = whole(random, 0, 1) == 0;
    const double lintel = slot ? 1.0 : uniform(random, sill + 0.1, 0.95);
    if (slot) {
        sheet.trims = {loop_of(
            {{0, 0}, {2, 0}, {2, 1}, {right, 1}, {right, sill}, {left, sill}, {left, 1}, {0, 1}})};
    } else {
        sheet.trims = {loop_of({{0, 0}, {2, 0}, {2, 1}, {0, 1}}),
                       loop_of({{left, sill}, {left, lintel}, {right, lintel}, {right, sill}})};
    }
    part.faces.push_back(sheet);
    const double r = arch.most_radius();
    add_facets(part.mesh, sheet, {0, 0}, {left, 1}, r);
    add_facets(part.mesh, sheet, {left, 0}, {right, sill}, r);
    add_facets(part.mesh, sheet, {right, 0}, {2, 1}, r);
    if (!slot) {
        add_facets(part.mesh, sheet, {left, lintel}, {right, 1}, r);
    }
}

// A plate with one to three round walls on its border, turned.
inline WalledPart round_walls(Random& random)
{
    const double length = uniform(random, 4.0, 9.0);
    const double width = uniform(random, 3.0, 7.0);
    const double rise = width * uniform(random, -0.3, 0.3);
    WalledPart part;
    add_quad(part.mesh, {0, 0, 0}, {length, 0, 0}, {length, width, rise}, {0, width, rise});
    part.faces = faces_of(part.mesh);
    for (int k = whole(random, 1, 3); k > 0; --k) {
        add_round_wall(random, part,
                       {uniform(random, 0.0, length),
                        whole(random, 0, 1) == 0 ? 0.0 : uniform(random, -1.5, 2.0)});
    }
    const double angle = uniform(random, 0.0, 2 * kPi);
    part.mesh = turned(part.mesh, angle);
    for (nurbs::Surface& face : part.faces) {
        for (Vec3d& p : face.points) {
            p = {p.x * std::cos(angle) - p.y * std::sin(angle),
                 p.x * std::sin(angle) + p.y * std::cos(angle), p.z};
        }
    }
    return part;
}

}  // namespace cusp::test
