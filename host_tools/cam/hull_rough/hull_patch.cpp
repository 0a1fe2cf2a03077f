// Homogeneous control nets are halved by averages; a part of a hull follows from pairs of points.
#include "host_tools/cam/hull_rough/hull_patch.hpp"

#include <algorithm>
#include <utility>

namespace cusp::hull_rough {

using nurbs::BezierPatch;
using nurbs::Surface;
using part_model::TrimRegion;

namespace {

struct Homogeneous {
    Vec3d point;  // times weight
    double weight;
};

Homogeneous middle(const Homogeneous& a, const Homogeneous& b)
{
    return {(a.point + b.point) * 0.5, (a.weight + b.weight) * 0.5};
}

using Net = std::vector<Homogeneous>;

// Halves the polynomial of `degree` + 1 control points, `stride` apart from `first` on.
void halve(Net net, Net& low, Net& high, std::size_t first, std::size_t stride, int degree)
{
    const auto at = [&](int i) {
        return first + static_cast<std::size_t>(i) * stride;
    };
    for (int step = 0; step <= degree; ++step) {
        low[at(step)] = net[at(0)];
        high[at(degree - step)] = net[at(degree - step)];
        for (int i = 0; i < degree - step; ++i) {
            net[at(i)] = middle(net[at(i)], net[at(i + 1)]);
        }
    }
}

std::array<Net, 2> halves(const Net& net, int degree_u, int degree_v, bool along_u)
{
    std::array<Net, 2> out{net, net};
    const auto row = static_cast<std::size_t>(degree_v) + 1;
    const int lines = along_u ? degree_v : degree_u;
    for (int i = 0; i <= lines; ++i) {
        const auto line = static_cast<std::size_t>(i);
        halve(net, out[0], out[1], along_u ? line : line * row, along_u ? row : 1,
              along_u ? degree_u : degree_v);
    }
    return out;
}

void set_height(HullPatch& patch)
{
    const auto [low, high] = std::minmax_element(patch.points.begin(), patch.points.end(),
                                                 [](Vec3d a, Vec3d b) { return a.z < b.z; });
    patch.bottom = low->z;
    patch.top = high->z;
}

HullPatch from_net(const Net& net, int degree_u, int degree_v)
{
    HullPatch patch;
    patch.degree_u = degree_u;
    patch.degree_v = degree_v;
    for (const Homogeneous& h : net) {
        patch.points.push_back(h.point / h.weight);
        patch.weights.push_back(h.weight);
    }
    set_height(patch);
    return patch;
}

void include(std::optional<Rectangle>& box, double x, double y)
{
    if (!box) {
        box = Rectangle{x, y, x, y};
        return;
    }
    box->x_min = std::min(box->x_min, x);
    box->x_max = std::max(box->x_max, x);
    box->y_min = std::min(box->y_min, y);
    box->y_max = std::max(box->y_max, y);
}

void collect(const HullPatch& patch, double plane, int levels, std::vector<Rectangle>& out)
{
    if (patch.top <= plane) {
        return;
    }
    if (patch.bottom >= plane || levels == 0) {
        if (const auto box = plan_box_above(patch, plane)) {
            out.push_back(*box);
        }
        return;
    }
    for (const HullPatch& quarter : quarters(patch)) {
        collect(quarter, plane, levels - 1, out);
    }
}

// Adds the patch, unless it is trimmed away.
void add_kept(HullPatch patch, std::vector<HullPatch>& out)
{
    if (patch.trims) {
        const TrimRegion::Part part =
            patch.trims->part(patch.u[0], patch.u[1], patch.v[0], patch.v[1]);
        if (part == TrimRegion::Part::kOutside) {
            return;
        }
        if (part == TrimRegion::Part::kInside) {
            patch.trims.reset();
        }
    }
    out.push_back(std::move(patch));
}

// Adds the patch, quartered where an edge crosses it.
void add_fitted(HullPatch patch, int levels, std::vector<HullPatch>& out)
{
    std::vector<HullPatch> kept;
    add_kept(std::move(patch), kept);
    for (HullPatch& piece : kept) {
        if (!piece.trims || levels == 0) {
            out.push_back(std::move(piece));
            continue;
        }
        for (HullPatch& quarter : quarters(piece)) {
            add_fitted(std::move(quarter), levels - 1, out);
        }
    }
}

}  // namespace

std::vector<HullPatch> hull_patches(const std::vector<Surface>& surfaces)
{
    constexpr int kTrimLevels = 4;
    std::vector<HullPatch> out;
    for (const Surface& surface : surfaces) {
        const auto trims = surface.trims.empty()
                               ? nullptr
                               : std::make_shared<const TrimRegion>(surface, kTrimError);
        for (BezierPatch& piece : bezier_patches(surface)) {
            HullPatch patch{piece.surface.degree_u,
                            piece.surface.degree_v,
                            std::move(piece.surface.points),
                            std::move(piece.surface.weights),
                            0,
                            0,
                            trims,
                            {piece.u_begin, piece.u_end},
                            {piece.v_begin, piece.v_end}};
            set_height(patch);
            add_fitted(std::move(patch), kTrimLevels, out);
        }
    }
    return out;
}

std::vector<HullPatch> quarters(const HullPatch& patch)
{
    Net net(patch.points.size());
    for (std::size_t i = 0; i < net.size(); ++i) {
        net[i] = {patch.points[i] * patch.weights[i], patch.weights[i]};
    }
    const auto along_u = halves(net, patch.degree_u, patch.degree_v, true);
    const std::array<double, 3> u{patch.u[0], (patch.u[0] + patch.u[1]) / 2, patch.u[1]};
    const std::array<double, 3> v{patch.v[0], (patch.v[0] + patch.v[1]) / 2, patch.v[1]};
    std::vector<HullPatch> out;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto along_v = halves(along_u[i], patch.degree_u, patch.degree_v, false);
        for (std::size_t j = 0; j < 2; ++j) {
            HullPatch quarter = from_net(along_v[j], patch.degree_u, patch.degree_v);
            quarter.trims = patch.trims;
            quarter.u = {u[i], u[i + 1]};
            quarter.v = {v[j], v[j + 1]};
            add_kept(std::move(quarter), out);
        }
    }
    return out;
}

Rectangle plan_box(const HullPatch& patch)
{
    std::optional<Rectangle> box;
    for (const Vec3d& p : patch.points) {
        include(box, p.x, p.y);
    }
    return *box;
}

std::optional<Rectangle> plan_box_above(const HullPatch& patch, double plane)
{
    std::optional<Rectangle> box;
    const auto& points = patch.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].z <= plane) {
            continue;
        }
        include(box, points[i].x, points[i].y);
        // The part of the hull above the plane is the hull of the points above and of the
        // intersections of the plane with segments to the points below.
        for (const Vec3d& below : points) {
            if (below.z <= plane) {
                const double t = (plane - below.z) / (points[i].z - below.z);
                const Vec3d meet = below + (points[i] - below) * t;
                include(box, meet.x, meet.y);
            }
        }
    }
    return box;
}

std::vector<Rectangle> boxes_above(const std::vector<HullPatch>& patches, double plane, int levels)
{
    std::vector<Rectangle> out;
    for (const HullPatch& patch : patches) {
        if (levels > 0) {
            collect(patch, plane, levels, out);
        } else if (patch.top > plane) {
            out.push_back(plan_box(patch));
        }
    }
    return out;
}

}  // namespace cusp::hull_rough
