// Pairs of regions that overlays find hard, from a seed: shared edges, touching corners, tangent
// and equal arcs, slivers, copies moved or turned by next to nothing.
#pragma once

#include "host_tools/geometry/offset/offset.hpp"
#include "tests/generators/random_regions.hpp"

namespace cusp::test {

struct RegionPair {
    const char* kind;
    offset::Region2d a;
    offset::Region2d b;
};

inline int whole(Random& random, int low, int high)
{
    return static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1)) + low;
}

inline offset::Region2d polygon_region(const std::vector<Vec2d>& corners)
{
    offset::Contour contour;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        contour.push_back(offset::line_edge(corners[i], corners[(i + 1) % corners.size()]));
    }
    return {{contour}};
}

inline offset::Region2d box_on_grid(Random& random)
{
    const double x = whole(random, 0, 4);
    const double y = whole(random, 0, 4);
    const double w = whole(random, 1, 4);
    const double h = whole(random, 1, 4);
    return polygon_region({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
}

inline offset::Region2d disc(Vec2d c, double r, double turned = 0.0)
{
    offset::Contour contour;
    const auto at = [&](int k) {
        const double angle = turned + k * 1.5707963267948966;
        return c + Vec2d{std::cos(angle), std::sin(angle)} * r;
    };
    for (int k = 0; k < 4; ++k) {
        contour.push_back({at(k), at((k + 1) % 4), c, r, 1});
    }
    return {{contour}};
}

// All points no farther than `r` from a line between two points of the grid.
inline offset::Region2d slot_on_grid(Random& random)
{
    const Vec2d a{1.0 * whole(random, 0, 4), 1.0 * whole(random, 0, 4)};
    const double size = whole(random, 1, 3);
    const double r = 0.5 * whole(random, 1, 3);
    const Vec2d along = whole(random, 0, 1) == 0 ? Vec2d{1, 0} : Vec2d{0, 1};
    const Vec2d side = offset::left_normal(along) * r;
    const Vec2d b = a + along * size;
    return {{{offset::line_edge(a - side, b - side),
              {b - side, b + along * r, b, r, 1},
              {b + along * r, b + side, b, r, 1},
              offset::line_edge(b + side, a + side),
              {a + side, a - along * r, a, r, 1},
              {a - along * r, a - side, a, r, 1}}}};
}

inline offset::Region2d moved(const offset::Region2d& region, double angle, Vec2d by)
{
    const auto at = [&](Vec2d p) {
        return p * std::cos(angle) + offset::left_normal(p) * std::sin(angle) + by;
    };
    offset::Region2d out = region;
    for (offset::Contour& contour : out.contours) {
        for (offset::Edge& edge : contour) {
            edge = {at(edge.start), at(edge.end), at(edge.centre), edge.radius, edge.turn};
        }
    }
    return out;
}

// From 1e-9 to 1e-2, or nothing.
inline double tiny(Random& random)
{
    return whole(random, 0, 4) == 0 ? 0.0 : std::pow(10.0, uniform(random, -9.0, -2.0));
}

struct PairSize {
    RegionSize region{};
    int most_edges{300};
};

// A judge is quick with these.
inline constexpr PairSize kSmallPairs{{0.05, 6, 2}, 12};

inline offset::Region2d of_many_edges(Random& random, PairSize size)
{
    const double scale = size.region.scale;
    while (true) {
        const Vec2d at = scale * Vec2d{uniform(random, -10, 10), uniform(random, -10, 10)};
        offset::Region2d out{
            {random_star(random, at, 40.0 * scale, whole(random, 3, size.most_edges), 0.0)}};
        if (offset::area(out) > scale * scale && !offset::find_fault(out)) {
            return out;
        }
    }
}

inline offset::Region2d sliver(Random& random)
{
    const double thin = std::pow(10.0, uniform(random, -6.0, -1.0));
    const double y = whole(random, 0, 3);
    return polygon_region({{0, y}, {6, y}, {6.0 * whole(random, 0, 1), y + thin}});
}

inline RegionPair random_pair(std::uint64_t seed, PairSize size = {})
{
    Random random{seed};
    const double scale = size.region.scale;
    const auto some_region = [&] {
        return random_region(random, size.region);
    };
    const auto with_more = [&](offset::Region2d region, auto make) {
        for (int k = whole(random, 0, 3); k > 0; --k) {
            const offset::Region2d more = make(random);
            region.contours.push_back(more.contours.front());
        }
        return region;
    };
    const auto on_grid = [](Random& r) {
        return disc({1.0 * whole(r, 0, 4), 1.0 * whole(r, 0, 4)}, 0.5 * whole(r, 1, 5),
                    whole(r, 0, 1) == 0 ? 0.0 : uniform(r, 0, 3));
    };
    switch (seed % 10) {
        case 0:
            return {"regions of lines and arcs", some_region(),
                    moved(some_region(), uniform(random, 0, 6),
                          scale * Vec2d{uniform(random, -40, 40), uniform(random, -40, 40)})};
        case 1:
            return {"rectangles on a grid", with_more(box_on_grid(random), box_on_grid),
                    with_more(box_on_grid(random), box_on_grid)};
        case 2:
            return {"discs on a grid", with_more(on_grid(random), on_grid),
                    with_more(on_grid(random), on_grid)};
        case 3:
            return {"slots on a grid", with_more(slot_on_grid(random), slot_on_grid),
                    with_more(slot_on_grid(random), box_on_grid)};
        case 4: {
            const offset::Region2d a = some_region();
            const offset::RegionOffset kernel{a};
            const double distance = scale * uniform(random, 0.1, 5.0);
            const double other = distance + (whole(random, 0, 1) == 0 ? 0.0 : tiny(random));
            return {"offsets of one region", kernel.at(distance), kernel.at(other)};
        }
        case 5: {
            const offset::Region2d a = some_region();
            return {"a copy turned by little", a, moved(a, tiny(random), {})};
        }
        case 6: {
            const offset::Region2d a = some_region();
            const offset::Edge& edge = a.contours.front().front();
            const Vec2d way = offset::unit(edge.end - edge.start);
            const Vec2d by = whole(random, 0, 1) == 0 ? way * (scale * uniform(random, 0, 9))
                                                      : way * tiny(random);
            return {"a copy moved along an edge", a, moved(a, 0.0, by)};
        }
        case 7: {
            offset::Region2d a = some_region();
            const offset::Region2d b{{a.contours.front()}};
            const offset::Contour twice = a.contours[random() % a.contours.size()];
            a.contours.push_back(twice);
            return {"a contour twice", a, b};
        }
        case 8:
            return {"slivers", with_more(sliver(random), sliver),
                    with_more(box_on_grid(random), sliver)};
        default:
            return {"contours of many edges", of_many_edges(random, size),
                    of_many_edges(random, size)};
    }
}

}  // namespace cusp::test
