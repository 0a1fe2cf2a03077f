// cusp info: describes a part file.
#include <cmath>
#include <memory>

#include "firmware/base/inch.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/job/import/part_geometry_reader.hpp"
#include "host_tools/job/part_info/part_info.hpp"
#include "host_tools/judge/report/part_picture.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

namespace {

struct InfoOptions {
    std::vector<std::string> files;
    std::string units{"mm"};
    std::string stats;
    std::string picture;
    double tolerance{0.01};
};

int run_info(const InfoOptions& options)
{
    if (!options.picture.empty() && options.files.size() > 1) {
        throw InputError(
            fmt::format("--picture: {} files; a picture is of one: call cusp info once for each",
                        options.files.size()));
    }
    if (!std::isfinite(options.tolerance)) {  // CLI11 accepts nan
        throw InputError(fmt::format("--tolerance is {} mm, a number from 0.0001 to 10 is needed",
                                     options.tolerance));
    }
    const double millimetres = options.units == "inch" ? kMillimetresPerInch : 1.0;
    std::vector<part_info::PartInfo> parts;
    std::string text;
    for (const std::string& file : options.files) {
        parts.push_back(part_info::inspect_part(import::read_part_geometry(file, millimetres),
                                                options.tolerance));
        text += (text.empty() ? "" : "\n") + text_of(parts.back());
        if (options.picture.empty()) {  // only the picture needs them later
            parts.back().part.surfaces = {};
            parts.back().part.triangles = {};
        }
    }
    std::vector<files::NewFile> outputs;
    if (!options.picture.empty()) {
        outputs.push_back({options.picture, report::part_picture(parts.front())});
    }
    if (!options.stats.empty()) {
        outputs.push_back({options.stats, json_of(parts)});
    }
    write_all(outputs);
    fmt::print("{}", text);
    return kDone;
}

}  // namespace

void add_info_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand(
        "info", "describe a part: unit, size, faces, loops, undercuts, the largest ball");
    command->footer(
        "  cusp info bracket.step\n"
        "  cusp info plate.dxf#outline --picture plate.svg\n"
        "\n"
        "Reads .json, .step, .iges, .brep, .stl, .obj, .3mf, .png, .dxf, .svg, Gerber (.gbr) and\n"
        "Excellon (.drl). Lists the loops and\n"
        "open ends of each layer of a drawing, and the holes of a mesh. \"Largest ball\" is the "
        "largest "
        "ball\n"
        "end that reaches every point visible from above within --tolerance, shank included.\n"
        "It is computed at up to 60 000 points, sharp edges first, to 5 %; a tighter spot\n"
        "between them may be missed. For STL, --tolerance should be at least the deviation of\n"
        "the facets.\n"
        "\"Undercuts\" is the area that no tool from above can reach.\n"
        "The exit status is 2 if a file can't be read; then nothing is written.");
    auto options = std::make_shared<InfoOptions>();
    command->add_option("FILE", options->files, "parts; FILE#LAYER for a layer of a drawing")
        ->required();
    command->add_option("--units", options->units, "unit of files that name none: mm or inch")
        ->check(CLI::IsMember({"mm", "inch"}))
        ->capture_default_str();
    command->add_option("--tolerance", options->tolerance, "mm of stock that a ball may leave")
        ->check(CLI::Range(1e-4, 10.0))
        ->capture_default_str();
    command->add_option("--stats", options->stats,
                        "the description to write (JSON), in mm and degrees");
    command->add_option("--picture", options->picture,
                        "picture to write (SVG) of one file, from above");
    run_when_called(*command, work, options, run_info);
}

}  // namespace cusp::cli
