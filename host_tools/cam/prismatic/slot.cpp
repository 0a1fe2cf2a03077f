// The line itself, then loops around it, outward to the width.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/line_paths.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/cam/prismatic/profile_contours.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Job;
using job::Operation;
using offset::Contour;
using offset::Edge;
using toolpath::PlannedOperation;
using Kind = job::KeyKind;

namespace {

void check_slot(const Operation& operation, const job::Refuse& refuse)
{
    check_level(operation, refuse);
    const double width = operation.prismatic->width;
    const double across = 2 * operation.tool.radius;
    if (width > 0 && width < across) {
        refuse("width", fmt::format("is {:g} mm, tool {} is {:g} mm wide", width,
                                    operation.tool.number, across));
    }
    job::need(!operation.prismatic->file.empty(), "boundary",
              "a drawing of its middle line, such as \"plate.dxf#slots\"", operation, refuse);
}

LineCut slot_along(const Operation& operation, const std::vector<Edge>& line)
{
    const double radius = operation.tool.radius;
    const double beside = operation.prismatic->width / 2 - radius;
    const double step = std::min(operation.passes.step_over.value_or(radius), 2 * radius);
    LineCut cut{{line}};
    const int loops = beside > kFit ? static_cast<int>(std::ceil(beside / step)) : 0;
    for (int k = 1; k <= loops; ++k) {
        for (const Contour& contour : around_line(line, beside * k / loops)) {
            // its left is the wall
            const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
            cut.paths.push_back(climb ? reversed(contour) : contour);
        }
    }
    return cut;
}

std::vector<PlannedOperation> plan_slot(const Job& job, const Operation& operation)
{
    std::vector<LineCut> cuts;
    for (const job::Chain& chain : operation.prismatic->chains) {
        const std::vector<Edge> line = edges_along(chain);
        if (!line.empty()) {
            cuts.push_back(slot_along(operation, line));
        }
    }
    if (cuts.empty()) {
        throw InputError(operation_text(job, operation) + operation.prismatic->file +
                         ": no line to cut a slot along");
    }
    const std::string text =
        fmt::format("{}, {:g} mm wide, {:g} mm deep", counted(cuts.size(), "line"),
                    std::max(operation.prismatic->width, 2 * operation.tool.radius),
                    operation.prismatic->depth);
    return {cut_lines(job, operation, text, std::move(cuts))};
}

}  // namespace

const job::Strategy kSlot{
    "slot",
    "along lines and curves of a drawing, as wide as the tool or wider, with round ends",
    job::shared_keys(job::with_text({"output", "direction_of_cut", "entry", "max_depth",
                                     "step_over", "depth", "top", "may_open"})),
    {{"width", Kind::kLength, "the tool's diameter", "across the line", job::kPositive}},
    {job::Region::kGrooves},
    nullptr,
    check_slot,
    plan_slot};

}  // namespace cusp::prismatic
