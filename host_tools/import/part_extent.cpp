// Measures each side of the box as the highest place of a model that is turned so that it is up.
#include "host_tools/import/part_extent.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "host_tools/part_model/part_model.hpp"

namespace cusp::import {

using nurbs::Surface;
using part_model::PartModel;

namespace {

Vec3d least(Vec3d a, Vec3d b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Vec3d greatest(Vec3d a, Vec3d b)
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// The highest place after `turn`, which maps the points of the surfaces. No surface rises over its
// control points, so surfaces that might rise most come first, and few are evaluated.
template <class Turn>
double highest_after(const Turn& turn, const std::vector<Surface>& surfaces)
{
    std::vector<std::pair<double, const Surface*>> bounds;
    for (const Surface& surface : surfaces) {
        double bound = turn(surface.points.front()).z;
        for (const Vec3d point : surface.points) {
            bound = std::max(bound, turn(point).z);
        }
        bounds.emplace_back(bound, &surface);
    }
    std::stable_sort(bounds.begin(), bounds.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    double highest = -std::numeric_limits<double>::infinity();
    for (const auto& [bound, surface] : bounds) {
        if (bound <= highest) {
            break;
        }
        Surface turned = *surface;
        std::transform(turned.points.begin(), turned.points.end(), turned.points.begin(), turn);
        highest = std::max(highest, PartModel{std::vector{turned}}.highest());
    }
    return highest;
}

}  // namespace

PartExtent extent_of_surfaces(const std::vector<Surface>& surfaces)
{
    const auto highest = [&](auto turn) {
        return highest_after(turn, surfaces);
    };
    PartExtent box;
    box.high = {highest([](Vec3d p) {
                    return Vec3d{p.y, p.z, p.x};
                }),
                highest([](Vec3d p) {
                    return Vec3d{p.z, p.x, p.y};
                }),
                highest([](Vec3d p) { return p; })};
    box.low = {-highest([](Vec3d p) {
                   return Vec3d{p.y, -p.z, -p.x};
               }),
               -highest([](Vec3d p) {
                   return Vec3d{p.z, -p.x, -p.y};
               }),
               -highest([](Vec3d p) {
                   return Vec3d{p.x, -p.y, -p.z};
               })};
    return box;
}

PartExtent extent_of_triangles(const Triangles& triangles)
{
    PartExtent box{triangles.front().front(), triangles.front().front()};
    for (const std::array<Vec3d, 3>& triangle : triangles) {
        for (const Vec3d corner : triangle) {
            box = {least(box.low, corner), greatest(box.high, corner)};
        }
    }
    return box;
}

PartExtent joined(const PartExtent& a, const PartExtent& b)
{
    return {least(a.low, b.low), greatest(a.high, b.high)};
}

}  // namespace cusp::import
