// Edges are sampled, and the samples fitted by the firmware's segmenter.
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/segmenter/arc_fitter.hpp"

namespace cusp::waterline_slices {

using offset::arc_edge;
using offset::area;
using offset::Contour;
using offset::Edge;
using offset::length;
using offset::line_edge;
using offset::Region2d;

namespace {

constexpr std::size_t kMostVertices = 2000;  // replaced by one move

// The arc with its centre moved so that both ends have exactly one radius, as offsets require.
Edge exact_arc(Vec2d start, Vec2d end, Vec2d centre, int turn)
{
    const Vec2d chord = end - start;
    const Vec2d middle = (start + end) * 0.5;
    return arc_edge(start, end, centre - chord * (dot(centre - middle, chord) / dot(chord, chord)),
                    turn);
}

}  // namespace

std::vector<Edge> fitted_edges(const std::vector<Edge>& edges, double tolerance, bool arcs)
{
    constexpr double kSample = 1e-4;
    std::vector<Vec3d> vertices{{edges.front().start.x, edges.front().start.y, 0.0}};
    for (const Edge& edge : edges) {
        const double turn = edge.turn == 0 ? 0.0 : 2.0 * std::sqrt(2.0 * kSample / edge.radius);
        const int parts = edge.turn == 0 ? 1 : 1 + static_cast<int>(sweep(edge) / turn);
        for (int k = 1; k <= parts; ++k) {
            const Vec2d p = k == parts ? edge.end : point_on(edge, static_cast<double>(k) / parts);
            if (norm(p - in_plan(vertices.back())) > 1e-6) {
                vertices.push_back({p.x, p.y, 0.0});
            }
        }
    }
    if (vertices.size() < 2) {
        return {};
    }
    segmenter::FitSettings settings;
    settings.left = settings.right = tolerance;
    settings.arcs = arcs;
    settings.greatest_sweep = 3.0;
    settings.centre_step = 0;
    settings.greatest_radius = 1000;
    std::vector<Vec3d> room(std::clamp<std::size_t>(vertices.size(), 4, kMostVertices));
    segmenter::ArcFitter fitter{settings, {room.data(), room.size()}};
    fitter.start(vertices.front());
    std::vector<Edge> out;
    Vec2d at = edges.front().start;
    const auto take = [&] {
        for (segmenter::FittedMove move{}; fitter.next(move);) {
            const Vec2d end{move.end.x, move.end.y};
            const Vec2d centre = at + Vec2d{move.first_offset, move.second_offset};
            out.push_back(move.is_arc ? exact_arc(at, end, centre, move.clockwise ? -1 : 1)
                                      : line_edge(at, end));
            at = end;
        }
    };
    for (std::size_t k = 1; k < vertices.size(); ++k) {
        if (!fitter.has_room()) {
            take();
        }
        fitter.push(vertices[k]);
    }
    fitter.finish();
    take();
    return out;
}

Region2d fitted_region(const Region2d& region, double tolerance)
{
    Region2d out;
    for (const Contour& contour : region.contours) {
        Contour edges = fitted_edges(contour, tolerance, true);
        if (edges.size() >= 2 && std::abs(area(edges)) > tolerance * length(edges)) {
            out.contours.push_back(std::move(edges));
        }
    }
    return out;
}

}  // namespace cusp::waterline_slices
