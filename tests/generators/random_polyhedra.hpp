// Random meshes with steep walls and sharp edges, from a seed: drafts, chamfers, creases, slivers.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "firmware/base/math.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/support/box_mesh.hpp"

namespace cusp::test {

// A point of a profile: distance along it, and height.
using Profile = std::vector<Vec2d>;

inline Vec3d random_place(Random& random, const std::array<Vec3d, 3>& t)
{
    const double a = std::sqrt(uniform(random, 0.0, 1.0));
    const double b = uniform(random, 0.0, 1.0);
    return t[0] * (1 - a) + t[1] * (a * (1 - b)) + t[2] * (a * b);
}

// 0.1 to 5 degrees from the vertical, small ones as often as large ones; as a tangent.
inline double random_draft(Random& random)
{
    return std::tan(0.1 * kPi / 180 * std::pow(50.0, uniform(random, 0.0, 1.0)));
}

// Exactly vertical, or so that it leans by less than any scallop over the height of a part.
inline double random_upright_draft(Random& random)
{
    return whole(random, 0, 1) == 0 ? 0.0 : std::pow(10.0, uniform(random, -7.0, -3.0));
}

// Lean of its walls; kStanding: vertical ones with openings, and bodies on a plate's border;
// kRound: the same with curved faces, which round_walls.hpp makes; kLow: steps that are lower than
// a scallop.
enum class Walls { kDrafted, kUpright, kStanding, kRound, kLow };

inline void add_wall(Random& random, Profile& profile, double rise, Walls walls)
{
    const auto chamfer = [&] {
        if (whole(random, 0, 2) == 0) {
            const double wide = uniform(random, 0.05, 0.7);
            const double high = wide * uniform(random, 0.4, 2.0);
            profile.push_back(profile.back() + Vec2d{wide, rise > 0 ? high : -high});
        }
    };
    chamfer();
    const double draft =
        walls == Walls::kDrafted ? random_draft(random) : random_upright_draft(random);
    profile.push_back(profile.back() + Vec2d{std::abs(rise) * draft, rise});
    chamfer();
}

// Gentle ground and walls in turn, up to `length`.
inline Profile random_profile(Random& random, double length, Walls walls)
{
    Profile profile{{0, 0}};
    while (profile.back().x < length) {
        const double run = uniform(random, 0.4, 4.0);
        profile.push_back(profile.back() + Vec2d{run, run * uniform(random, -0.4, 0.4)});
        if (profile.back().x < length) {
            const double sign = profile.back().y > 0 ? -1 : 1;
            add_wall(random, profile, sign * uniform(random, 0.5, 6.0), walls);
        }
    }
    return profile;
}

// The profile along a bent line: creases cross its walls.
inline Triangles ribs(Random& random, Walls walls)
{
    const Profile profile = random_profile(random, uniform(random, 4.0, 9.0), walls);
    std::vector<Vec3d> line{{0, 0, 0}};
    for (int k = whole(random, 1, 3); k > 0; --k) {
        const double way = uniform(random, 2.0, 4.0);
        line.push_back(line.back() + Vec3d{way * uniform(random, -0.5, 0.5), way,
                                           way * uniform(random, -0.3, 0.3)});
    }
    Triangles out;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        // Ground that begins beside its wall, as where facets of a file are missing.
        const bool beside =
            walls == Walls::kUpright && whole(random, 0, 4) == 0 &&
            profile[i].x - profile[i - 1].x > std::abs(profile[i].y - profile[i - 1].y);
        const double share = beside ? uniform(random, 0.02, 0.6) : 0.0;
        const Vec2d first = profile[i - 1] + (profile[i] - profile[i - 1]) * share;
        for (std::size_t j = 1; j < line.size(); ++j) {
            const auto at = [&](Vec2d p, std::size_t b) {
                return line[b] + Vec3d{p.x, 0, p.y};
            };
            add_quad(out, at(first, j - 1), at(profile[i], j - 1), at(profile[i], j), at(first, j));
        }
    }
    return out;
}

// The profile inwards from the sides of a polygon: a boss, a pocket or both, with plane walls.
inline Triangles polygon_steps(Random& random, Walls walls)
{
    const int corners = whole(random, 3, 9);
    std::vector<Vec2d> ring;
    for (int k = 0; k < corners; ++k) {
        const double turn = 2 * kPi * (k + uniform(random, 0.0, 0.7)) / corners;
        ring.push_back({std::cos(turn), std::sin(turn)});
    }
    const double size = uniform(random, 4.0, 8.0);
    const Profile profile = random_profile(random, 0.5 * size, walls);
    Triangles out;
    const auto at = [&](std::size_t level, int corner) {
        const double radius = std::max(0.05, size - profile[level].x);
        const Vec2d way = ring[static_cast<std::size_t>(corner % corners)];
        return Vec3d{radius * way.x, radius * way.y, profile[level].y};
    };
    for (int k = 0; k < corners; ++k) {
        for (std::size_t i = 1; i < profile.size(); ++i) {
            add_quad(out, at(i - 1, k), at(i - 1, k + 1), at(i, k + 1), at(i, k));
        }
        const std::size_t last = profile.size() - 1;
        out.push_back({at(last, k), at(last, k + 1), Vec3d{0, 0, profile[last].y - 0.2}});
    }
    return out;
}

// Random heights over an uneven grid, steep in its narrow cells.
inline Triangles crags(Random& random)
{
    const auto places = [&] {
        std::vector<double> at{0};
        for (int k = whole(random, 3, 6); k > 0; --k) {
            const bool narrow = whole(random, 0, 2) == 0;
            at.push_back(at.back() +
                         (narrow ? uniform(random, 0.01, 0.2) : uniform(random, 0.8, 2.5)));
        }
        return at;
    };
    const std::vector<double> xs = places();
    const std::vector<double> ys = places();
    const double rough = uniform(random, 0.5, 4.0);
    std::vector<std::vector<Vec3d>> net;
    for (const double x : xs) {
        net.emplace_back();
        for (const double y : ys) {
            net.back().push_back({x, y, rough * uniform(random, 0.0, 1.0)});
        }
    }
    Triangles out;
    for (std::size_t i = 1; i < xs.size(); ++i) {
        for (std::size_t j = 1; j < ys.size(); ++j) {
            add_quad(out, net[i - 1][j - 1], net[i][j - 1], net[i][j], net[i - 1][j]);
        }
    }
    return out;
}

// Splits some triangles at places near the ends of their sides: slivers of a thousandth of a side.
inline Triangles with_slivers(Random& random, const Triangles& triangles)
{
    Triangles out;
    for (const auto& t : triangles) {
        if (whole(random, 0, 3) != 0) {
            out.push_back(t);
            continue;
        }
        const double share = std::pow(10.0, uniform(random, -3.0, -0.5));
        const Vec3d on_side = t[0] + (t[1] - t[0]) * share;
        out.push_back({t[0], on_side, t[2]});
        out.push_back({on_side, t[1], t[2]});
    }
    return out;
}

inline Triangles turned(const Triangles& triangles, double angle)
{
    Triangles out = triangles;
    for (auto& t : out) {
        for (Vec3d& p : t) {
            p = {p.x * std::cos(angle) - p.y * std::sin(angle),
                 p.x * std::sin(angle) + p.y * std::cos(angle), p.z};
        }
    }
    return out;
}

// A prism over a ring, its underside left out; `out` may have more of it.
inline void add_prism(Triangles& out, const std::vector<Vec2d>& ring, double low, double high)
{
    const auto at = [&](std::size_t k, double z) {
        const Vec2d p = ring[k % ring.size()];
        return Vec3d{p.x, p.y, z};
    };
    for (std::size_t k = 0; k < ring.size(); ++k) {
        add_quad(out, at(k, low), at(k + 1, low), at(k + 1, high), at(k, high));
        if (k > 1) {
            out.push_back({at(0, high), at(k - 1, high), at(k, high)});
        }
    }
}

// A wall along x in strips: teeth, slots, windows through it. thick: 0 for a sheet.
inline void add_pierced_wall(Random& random, Triangles& out, double y, double length, double thick)
{
    const double high = uniform(random, 1.0, 6.0);
    for (double x = uniform(random, -1.0, 1.0); x < length;) {
        const double wide = uniform(random, 0.2, 3.0);
        const double top = whole(random, 0, 1) == 0 ? high : uniform(random, 0.3, high);
        const double sill = whole(random, 0, 2) == 0 ? uniform(random, 0.0, 0.8) * top : top;
        const double lintel = uniform(random, sill, top);
        const auto strip = [&](double from, double to) {
            if (thick > 0) {
                add_prism(out, {{x, y}, {x + wide, y}, {x + wide, y + thick}, {x, y + thick}}, from,
                          to);
            } else {
                add_quad(out, {x, y, from}, {x + wide, y, from}, {x + wide, y, to}, {x, y, to});
            }
        };
        if (sill > 0) {
            strip(0, sill);
        }
        if (top > lintel) {
            strip(lintel, top);
        }
        x += wide + (whole(random, 0, 1) == 0 ? 0.0 : uniform(random, 0.1, 4.0));
    }
}

// Pierced walls, cylinders and fins on the border of a plate, within it and beyond.
inline Triangles standing_walls(Random& random)
{
    const double length = uniform(random, 4.0, 9.0);
    const double width = uniform(random, 3.0, 7.0);
    const double tilt = uniform(random, -0.3, 0.3);
    Triangles out;
    add_quad(out, {0, 0, 0}, {length, 0, 0}, {length, width, tilt * width},
             {0, width, tilt * width});
    const auto border = [&] {
        return whole(random, 0, 1) == 0 ? 0.0 : uniform(random, -0.8, 0.8);
    };
    for (int k = whole(random, 1, 3); k > 0; --k) {
        switch (whole(random, 0, 2)) {
            case 0:
                add_pierced_wall(random, out, border(), length,
                                 whole(random, 0, 1) == 0 ? 0.0 : uniform(random, 0.2, 1.0));
                break;
            case 1: {
                const double radius = uniform(random, 0.3, 2.5);
                const Vec2d middle{uniform(random, 0.0, length), border()};
                const int sides = whole(random, 5, 40);
                std::vector<Vec2d> ring;
                for (int side = 0; side < sides; ++side) {
                    const double turn = 2 * kPi * side / sides;
                    ring.push_back(middle + Vec2d{std::cos(turn), std::sin(turn)} * radius);
                }
                add_prism(out, ring, uniform(random, -3.0, 0.0), uniform(random, 0.5, 5.0));
                break;
            }
            default: {
                const Vec2d from{uniform(random, 0.0, length), border()};
                const double turn = uniform(random, 0.0, kPi);
                const Vec2d way = Vec2d{std::cos(turn), std::sin(turn)} * uniform(random, 0.5, 5.0);
                const Vec2d thick =
                    Vec2d{-std::sin(turn), std::cos(turn)} * uniform(random, 0.2, 1.0);
                add_prism(out, {from, from + way, from + way + thick, from + thick},
                          uniform(random, -3.0, 0.0), uniform(random, 0.5, 5.0));
            }
        }
    }
    return out;
}

// Slabs 0.0016 to 0.03 mm high, on strips of ground or over them: the ground beside a slab may begin
// anywhere.
inline Triangles low_steps(Random& random)
{
    const double length = uniform(random, 4.0, 9.0);
    Triangles out;
    double width = 0;
    for (int k = whole(random, 1, 3); k > 0; --k) {
        const double from = width + (width > 0 ? uniform(random, 0.1, 2.0) : 0.0);
        width = from + uniform(random, 1.0, 4.0);
        add_quad(out, {0, from, 0}, {length, from, 0}, {length, width, 0}, {0, width, 0});
    }
    for (int k = whole(random, 2, 6); k > 0; --k) {
        const Vec2d from{uniform(random, -1.0, length - 0.5), uniform(random, -1.0, width - 0.5)};
        const double turn =
            whole(random, 0, 1) == 0 ? 0.5 * kPi * whole(random, 0, 1) : uniform(random, 0.0, kPi);
        const Vec2d way = Vec2d{std::cos(turn), std::sin(turn)} * uniform(random, 0.3, 4.0);
        const Vec2d across = Vec2d{-std::sin(turn), std::cos(turn)} * uniform(random, 0.2, 4.0);
        const double low = whole(random, 0, 2) == 0 ? 0.0 : uniform(random, 0.0, 4.0);
        const double high = low + std::pow(10.0, uniform(random, -2.8, -1.5));
        add_prism(out, {from, from + way, from + way + across, from + across}, low, high);
    }
    return out;
}

inline Triangles random_polyhedron(Random& random, Walls walls = Walls::kDrafted)
{
    const int kind = whole(random, 0, walls == Walls::kDrafted ? 2 : 1);
    Triangles out = walls == Walls::kStanding ? standing_walls(random)
                    : walls == Walls::kLow    ? low_steps(random)
                    : kind == 0               ? ribs(random, walls)
                    : kind == 1               ? polygon_steps(random, walls)
                                              : crags(random);
    if (walls != Walls::kLow && whole(random, 0, 1) == 0) {
        out = with_slivers(random, out);
    }
    // Walls along the rows are those that rows miss.
    const bool along_rows = whole(random, 0, 2) == 0;
    return turned(out,
                  along_rows ? 0.5 * kPi * whole(random, 0, 3) : uniform(random, 0.0, 2 * kPi));
}

}  // namespace cusp::test
