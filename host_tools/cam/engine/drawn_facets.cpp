// Surfaces become triangles by the facets of part_info.
#include "host_tools/cam/engine/drawn_facets.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "host_tools/job/part_info/surface_facets.hpp"

namespace cusp::engine {
namespace {

constexpr double kShare = 1e-3;   // of the size of the surfaces
constexpr double kFinest = 0.02;  // mm

double size_of(const std::vector<nurbs::Surface>& surfaces)
{
    double low = 0;
    double high = 0;
    bool first = true;
    for (const nurbs::Surface& surface : surfaces) {
        for (const Vec3d& point : surface.points) {
            for (const double value : {point.x, point.y, point.z}) {
                low = first ? value : std::min(low, value);
                high = first ? value : std::max(high, value);
                first = false;
            }
        }
    }
    return high - low;
}

void add(std::vector<float>& to, const std::vector<std::array<Vec3d, 3>>& triangles)
{
    for (const auto& triangle : triangles) {
        for (const Vec3d& corner : triangle) {
            for (const double value : {corner.x, corner.y, corner.z}) {
                to.push_back(static_cast<float>(value));
            }
        }
    }
}

}  // namespace

std::string float_bytes(const std::vector<float>& values)
{
    static_assert(sizeof(float) == sizeof(std::uint32_t));
    std::string bytes;
    bytes.reserve(values.size() * sizeof(float));
    for (const float value : values) {
        std::uint32_t bits{};
        std::memcpy(&bits, &value, sizeof bits);
        for (unsigned k = 0; k < sizeof bits; ++k) {
            bytes.push_back(static_cast<char>(bits >> 8U * k & 0xffU));
        }
    }
    return bytes;
}

Json facets_json(const Call& call,
                 const std::vector<nurbs::Surface>& surfaces,
                 const std::vector<std::array<Vec3d, 3>>& triangles)
{
    std::vector<float> corners;
    if (!surfaces.empty()) {
        const double tolerance = std::max(kFinest, kShare * size_of(surfaces));
        add(corners, part_info::surface_facets(surfaces, tolerance).triangles);
    }
    add(corners, triangles);
    constexpr std::size_t kNumbers = 9;  // of a triangle
    const std::size_t count = corners.size() / kNumbers;
    return {{"triangles", count}, {"block", call.add_block("facets", float_bytes(corners))}};
}

}  // namespace cusp::engine
