// Halves strips breadth first: each stretch is examined when all coarser loops are in place.
#include "host_tools/cam/contour_pocket/loops_in_strip.hpp"

#include <cmath>

#include "host_tools/cam/clearing/corner_cleanup.hpp"
#include "host_tools/cam/clearing/partial_loops.hpp"

namespace cusp::contour_pocket {

using clearing::loops_over;
using clearing::LoopStrip;
using clearing::PartialLoop;
using clearing::starts_cleanup_spur;
using offset::Contour;
using offset::Edge;

namespace {

// A part of the strip with possibly too high a scallop, inward from `feet`.
struct Part {
    std::vector<Edge> feet;
    double from;
    double to;
};

}  // namespace

std::optional<std::vector<PartialLoop>> loops_in_strip(const LoopStrip& strip,
                                                       LoopScallop& loop_scallop,
                                                       double radius,
                                                       double max_length)
{
    constexpr double kOverlap = 0.02;  // of the tool's radius, besides half the strip's width
    std::vector<Edge> edges;
    std::vector<Edge> spurs;
    for (const Contour& contour : strip.outer.contours) {
        for (std::size_t e = 0; e < contour.size(); ++e) {
            if (starts_cleanup_spur(contour, e)) {
                spurs.push_back(contour[e++]);
            } else {
                edges.push_back(contour[e]);
            }
        }
    }
    loop_scallop.begin(strip);
    std::vector<PartialLoop> found;
    std::vector<Part> parts{{edges, strip.from, strip.to}};
    while (!parts.empty()) {
        std::vector<PartialLoop> added;
        std::vector<Part> halves;
        for (const Part& part : parts) {
            std::vector<Edge> high = loop_scallop.stretches(part.feet, strip, part.from, part.to);
            if (high.empty()) {
                continue;
            }
            const double middle = 0.5 * (part.from + part.to);
            const double margin = 0.5 * (part.to - part.from) + kOverlap * radius;
            const std::vector<PartialLoop> loops =
                loops_over(high, strip.walls, strip.from, middle, margin);
            added.insert(added.end(), loops.begin(), loops.end());
            halves.push_back({high, part.from, middle});
            halves.push_back({std::move(high), middle, part.to});
        }
        if (added_length(found) + added_length(added) > max_length) {
            return {};
        }
        if (!added.empty()) {
            loop_scallop.add(added);
            found.insert(found.end(), added.begin(), added.end());
        }
        parts = std::move(halves);
    }
    if (!loop_scallop.stretches(spurs, strip, strip.from, strip.to).empty()) {
        return {};
    }
    return found;
}

}  // namespace cusp::contour_pocket
