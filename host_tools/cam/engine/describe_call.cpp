// cusp info, and triangles to draw.
#include "firmware/base/inch.hpp"
#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/engine/drawn_facets.hpp"
#include "host_tools/job/import/part_geometry_reader.hpp"
#include "host_tools/job/part_info/part_info.hpp"

#include "fmt/format.h"

namespace cusp::engine {
namespace {

constexpr double kTolerance = 0.01;  // mm
constexpr double kLeastTolerance = 1e-4;
constexpr double kMostTolerance = 10;

double unit_of(const Arguments& arguments)
{
    const std::string unit = arguments.find_text("units").value_or("mm");
    if (unit != "mm" && unit != "inch") {
        throw InputError{
            fmt::format("describe: units: is \"{}\", known are \"mm\", \"inch\"", unit),
            {"", 0, "units", unit, "mm or inch"}};
    }
    return unit == "inch" ? kMillimetresPerInch : 1.0;
}

}  // namespace

Json describe_call(Call& call)
{
    const std::vector<std::string> files = call.arguments.texts("files");
    const double unit = unit_of(call.arguments);
    const double tolerance = call.arguments.find_number("tolerance").value_or(kTolerance);
    const bool facets = call.arguments.flag("facets", true);
    call.arguments.check_all_read();
    if (tolerance < kLeastTolerance || tolerance > kMostTolerance) {
        throw InputError{fmt::format("describe: tolerance: is {:g}, it must be {:g} to {:g} mm",
                                     tolerance, kLeastTolerance, kMostTolerance),
                         {"", 0, "tolerance", fmt::format("{:g}", tolerance), "0.0001 to 10 mm"}};
    }
    std::vector<part_info::PartInfo> parts;
    std::string text;
    Json drawn = Json::array();
    for (std::size_t k = 0; k < files.size(); ++k) {
        call.report(static_cast<double>(k) / static_cast<double>(files.size()),
                    "reading " + files[k]);
        parts.push_back(
            part_info::inspect_part(import::read_part_geometry(files[k], unit), tolerance));
        part_info::PartInfo& part = parts.back();
        text += (text.empty() ? "" : "\n") + text_of(part);
        if (facets && !part.is_drawing()) {
            Json entry{{"file", files[k]}};
            entry.update(facets_json(call, part.part.surfaces, part.part.triangles));
            drawn.push_back(std::move(entry));
        }
        part.part.surfaces = {};
        part.part.triangles = {};
    }
    Json result = Json::parse(json_of(parts));
    result["text"] = text;
    result["facets"] = drawn;
    return result;
}

}  // namespace cusp::engine
