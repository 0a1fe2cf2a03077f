// Tries biarcs to several points of the pass.
#include "host_tools/cam/clearing/loop_links.hpp"

#include <algorithm>

#include "host_tools/cam/clearing/clear_path.hpp"
#include "host_tools/cam/clearing/link_along_pass.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"

namespace cusp::clearing {

using offset::biarc_between;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::length;
using offset::line_edge;

namespace {

// Steps along the pass before a link reaches it: fewer where the pass soon turns.
constexpr double kAhead[] = {2.0, 1.4, 1.0, 0.7, 2.8};

// Turns the loop so that it starts at the point of it nearest to `from`.
void start_near(Contour& path, Vec2d from)
{
    std::size_t best = 0;
    double least = kUnbounded;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double apart = distance_to(path[i], from);
        if (apart < least) {
            least = apart;
            best = i;
        }
    }
    const Edge edge = path[best];
    const Vec2d p = nearest_on(edge, from);
    std::rotate(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(best), path.end());
    constexpr double kShortest = 1e-3;
    if (distance(p, edge.start) < kShortest) {
        return;
    }
    if (distance(p, edge.end) < kShortest) {
        std::rotate(path.begin(), path.begin() + 1, path.end());
        return;
    }
    path.front() = between(edge, p, edge.end);
    path.push_back(between(edge, edge.start, p));
}

// The point `way` after the start of the pass.
Vec2d place_after(const Contour& pass, double way)
{
    for (const Edge& edge : pass) {
        const double whole = length(edge);
        if (way < whole) {
            return point_on(edge, way / whole);
        }
        way -= whole;
    }
    return pass.front().start;
}

class Linker {
public:
    Linker(ClearingPass& pass, const Contour& before, const LinkSpace& room)
        : pass_{pass}, whole_{pass.path}, before_{before}, room_{room}
    {
    }

    bool run() { return reach_tangent() || reach_by_arc() || reach_straight() || reach_along(); }

private:
    bool is_free(const std::vector<Edge>& way) const
    {
        return std::all_of(way.begin(), way.end(), [&](const Edge& edge) {
            return cusp::clearing::is_path_clear(room_.offset, edge, room_.wall_clearance);
        });
    }

    // Each attempt splits an edge.
    void start_near_to(Vec2d place)
    {
        pass_.path = whole_;
        start_near(pass_.path, place);
    }

    // Tangent to both passes.
    bool reach_tangent()
    {
        const Vec2d from = before_.front().start;
        const Vec2d leaving = tangent_at_end(before_.back());
        for (const double ahead : kAhead) {
            start_near_to(from + leaving * (ahead * pass_.stepover));
            const Vec2d to = pass_.path.front().start;
            const bool onward = dot(to - from, leaving) > 0.5 * ahead * pass_.stepover;
            if (onward && go_over(leaving)) {
                return true;
            }
        }
        return false;
    }

    // From the end of the pass before, in any direction, tangent to the pass.
    bool reach_by_arc()
    {
        const Vec2d from = before_.front().start;
        start_near_to(from);
        const Contour nearest = pass_.path;
        for (const double ahead : kAhead) {
            start_near_to(place_after(nearest, ahead * pass_.stepover));
            const Vec2d over = pass_.path.front().start - from;
            const Vec2d arriving = tangent_at_start(pass_.path.front());
            const double along = dot(over, arriving);
            // The tangents of an arc at its ends are mirror images about its chord.
            const Vec2d leaving = over * (2.0 * along / dot(over, over)) - arriving;
            if (along > 0.0 && go_over(leaving)) {
                return true;
            }
        }
        return false;
    }

    bool go_over(Vec2d leaving)
    {
        constexpr double kLongest = 4.0;
        const Vec2d from = before_.front().start;
        const Edge& onto = pass_.path.front();
        const auto arcs = biarc_between(from, leaving, onto.start, tangent_at_start(onto));
        if (!arcs || distance(from, onto.start) >= kLongest * pass_.stepover) {
            return false;
        }
        pass_.link = {arcs->front(), arcs->back()};
        return is_free(pass_.link);
    }

    bool reach_straight()
    {
        constexpr double kLongest = 5.0;
        const Vec2d from = before_.front().start;
        start_near_to(from);
        pass_.link = {line_edge(from, pass_.path.front().start)};
        return length(pass_.link) < kLongest * room_.stepover && is_free(pass_.link);
    }

    bool reach_along()
    {
        constexpr double kFarthest = 1.5;  // of the step between neighbours
        const std::vector<Edge> link =
            link_along_pass(before_, pass_.path, kFarthest * pass_.stepover);
        if (link.empty() || !is_free({link.back()})) {
            return false;
        }
        start_near_to(link.back().end);
        pass_.link = link;
        pass_.link.back() = line_edge(link.back().start, pass_.path.front().start);
        return true;
    }

    ClearingPass& pass_;
    const Contour whole_;
    const Contour& before_;
    const LinkSpace& room_;
};

}  // namespace

void start_at_longest(Contour& path)
{
    const auto longest =
        std::max_element(path.begin(), path.end(),
                         [](const Edge& a, const Edge& b) { return length(a) < length(b); });
    start_near(path, point_on(*longest, 0.5));
}

void link_to(ClearingPass& pass, const Contour& before, const LinkSpace& room)
{
    pass.start = Linker{pass, before, room}.run() ? PassStart::kLink : PassStart::kRetractAndDrop;
}

}  // namespace cusp::clearing
