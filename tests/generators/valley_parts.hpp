// Small random parts with ground that an end can't touch: pits, grooves, walls on slanted ground, pockets.
#pragma once

#include <cmath>
#include <vector>

#include "firmware/base/math.hpp"
#include "tests/generators/random_polyhedra.hpp"

namespace cusp::test {

// Directions of the corners of a polygon.
inline std::vector<Vec2d> random_corners(Random& random)
{
    std::vector<Vec2d> out;
    const int corners = whole(random, 3, 6);
    for (int k = 0; k < corners; ++k) {
        const double turn = 2 * kPi * (k + uniform(random, 0.0, 0.6)) / corners;
        out.push_back({std::cos(turn), std::sin(turn)});
    }
    return out;
}

inline Triangles pit(Random& random)
{
    const std::vector<Vec2d> ring = random_corners(random);
    const double size = uniform(random, 3.0, 5.0);
    const Vec3d bottom{uniform(random, -0.8, 0.8), uniform(random, -0.8, 0.8),
                       -uniform(random, 1.0, 3.0)};
    Triangles out;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2d a = ring[k] * size;
        const Vec2d b = ring[(k + 1) % ring.size()] * size;
        out.push_back({Vec3d{a.x, a.y, 0}, Vec3d{b.x, b.y, 0}, bottom});
    }
    return out;
}

// Open at both ends, level or tilted.
inline Triangles grooves(Random& random)
{
    Profile profile{{0, 0}};
    const auto go = [&](double run, double rise) {
        profile.push_back(profile.back() + Vec2d{run, rise});
    };
    for (int k = whole(random, 1, 2); k > 0; --k) {
        go(uniform(random, 0.5, 1.5), uniform(random, -0.2, 0.2));
        const double down = uniform(random, 0.5, 2.5);
        go(down * uniform(random, 0.05, 1.2), -down);
        if (whole(random, 0, 1) == 0) {
            go(uniform(random, 0.3, 3.0), uniform(random, -0.1, 0.1));
        }
        const double up = uniform(random, 0.5, 2.5);
        go(up * uniform(random, 0.05, 1.2), up);
    }
    go(uniform(random, 0.5, 1.5), 0);
    const double length = uniform(random, 4.0, 7.0);
    const double tilt = whole(random, 0, 1) == 0 ? 0.0 : uniform(random, -0.4, 0.4);
    Triangles out;
    for (std::size_t k = 1; k < profile.size(); ++k) {
        const Vec2d a = profile[k - 1];
        const Vec2d b = profile[k];
        add_quad(out, {a.x, 0, a.y}, {b.x, 0, b.y}, {b.x, length, b.y + tilt * length},
                 {a.x, length, a.y + tilt * length});
    }
    return out;
}

// A step, upright or leaning, up from slanted ground.
inline Triangles wall_on_slant(Random& random)
{
    const double width = uniform(random, 4.0, 6.0);
    const double length = uniform(random, 3.0, 6.0);
    const double slope = uniform(random, -0.5, 0.5);
    const double tilt = uniform(random, -0.3, 0.3);
    const double foot = uniform(random, 1.5, width - 1.5);
    const double high = uniform(random, 0.5, 2.5);
    const double lean = whole(random, 0, 2) == 0 ? uniform(random, 0.0, 0.5) * high : 0.0;
    const auto at = [&](double x, double y, double over) {
        return Vec3d{x, y, slope * std::min(x, foot) + tilt * y + over};
    };
    Triangles out;
    add_quad(out, at(0, 0, 0), at(foot, 0, 0), at(foot, length, 0), at(0, length, 0));
    add_quad(out, at(foot, 0, 0), at(foot + lean, 0, high), at(foot + lean, length, high),
             at(foot, length, 0));
    add_quad(out, at(foot + lean, 0, high), at(width + lean, 0, high),
             at(width + lean, length, high), at(foot + lean, length, high));
    return out;
}

// A floor that falls to its middle, walls, a rim.
inline Triangles pocket_with_rim(Random& random)
{
    const std::vector<Vec2d> ring = random_corners(random);
    const double size = uniform(random, 2.5, 4.0);
    const double down = uniform(random, 0.5, 2.0);
    const double draft = whole(random, 0, 1) == 0 ? 0.0 : uniform(random, 0.0, 0.6) * down;
    const Vec3d middle{0, 0, -down - uniform(random, 0.0, 0.4)};
    Triangles out;
    const auto at = [&](std::size_t k, double radius, double z) {
        const Vec2d p = ring[k % ring.size()] * radius;
        return Vec3d{p.x, p.y, z};
    };
    for (std::size_t k = 0; k < ring.size(); ++k) {
        add_quad(out, at(k, size + 1, 0), at(k + 1, size + 1, 0), at(k + 1, size, 0),
                 at(k, size, 0));
        add_quad(out, at(k, size, 0), at(k + 1, size, 0), at(k + 1, size - draft, -down),
                 at(k, size - draft, -down));
        out.push_back({at(k, size - draft, -down), at(k + 1, size - draft, -down), middle});
    }
    return out;
}

inline Triangles valley_part(Random& random)
{
    Triangles out;
    switch (whole(random, 0, 3)) {
        case 0:
            out = pit(random);
            break;
        case 1:
            out = grooves(random);
            break;
        case 2:
            out = wall_on_slant(random);
            break;
        default:
            out = pocket_with_rim(random);
    }
    return whole(random, 0, 1) == 0 ? out : turned(out, uniform(random, 0.0, 2 * kPi));
}

}  // namespace cusp::test
