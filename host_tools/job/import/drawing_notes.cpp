#include "host_tools/job/import/drawing_notes.hpp"

#include <algorithm>

#include "host_tools/job/import/dxf_plane.hpp"
#include "host_tools/job/import/nearest_name.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

void note_texts(const std::string& name,
                std::size_t texts,
                Vec2d first,
                std::vector<std::string>& notes)
{
    const bool one = texts == 1;
    notes.push_back(fmt::format(
        "{}: {} at x {:.6g} y {:.6g} mm {} not cut: convert text to curves in the drawing "
        "program",
        name, one ? "a text" : fmt::format("{} texts, the first", texts), first.x, first.y,
        one ? "is" : "are"));
}

void note_left_out(const std::string& name,
                   const std::map<std::string, std::size_t>& kinds,
                   std::vector<std::string>& notes)
{
    if (!kinds.empty()) {
        std::vector<std::string> counts;
        for (const auto& [kind, count] : kinds) {
            counts.push_back(fmt::format("{} {}", count, kind));
        }
        notes.push_back(fmt::format("{}: left out, since they draw no curve: {}", name,
                                    fmt::join(counts, ", ")));
    }
}

void note_far(const std::string& file,
              const std::vector<DrawingPath>& paths,
              std::vector<std::string>& notes)
{
    constexpr double kFar = 1e5;  // mm: larger than most tables
    const DrawingBox box = extent_of(paths);
    const Vec3d nearest{std::max({box.low.x, -box.high.x, 0.0}),
                        std::max({box.low.y, -box.high.y, 0.0}), 0};
    if (!paths.empty() && norm(nearest) > kFar) {
        notes.push_back(
            fmt::format("{}: drawn at x {:.10g} y {:.10g} mm, far from the origin: "
                        "[placing] with origin = \"corner\" moves it there",
                        file, box.low.x, box.low.y));
    }
}

std::string nearest_layers(const std::string& layer, const std::set<std::string>& layers)
{
    constexpr std::size_t kNamed = 3;
    return fmt::format(
        "; layers of the drawing: \"{}\"{}",
        fmt::join(nearest_names(layer, {layers.begin(), layers.end()}, kNamed), "\", \""),
        layers.size() > kNamed ? " and more" : "");
}

}  // namespace cusp::import
