// cusp verify.
#include <cmath>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/engine/drawn_facets.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/verify/verify_statistics.hpp"

#include "fmt/format.h"

namespace cusp::engine {

using verify::Verification;
using verify::VerifySettings;

namespace {

constexpr double kLeastEngagement = 1;  // degrees
constexpr double kMostEngagement = 180;

VerifySettings settings_of(const Arguments& given)
{
    VerifySettings settings;
    settings.engagement = given.flag("engagement", true);
    settings.max_engagement = given.find_number("max_engagement");
    settings.pitch = given.find_number("grid");
    settings.spacing = given.find_number("step");
    const auto check = [](const char* key, std::optional<double> value, double least, double most) {
        if (value && !(*value >= least && *value <= most)) {
            const std::string limit = fmt::format("{:g} to {:g}", least, most);
            throw InputError{fmt::format("verify: {}: is {:g}, it must be {}", key, *value, limit),
                             {"", 0, key, fmt::format("{:g}", *value), limit}};
        }
    };
    constexpr double kLeast = 1e-3;  // mm
    constexpr double kMost = 100;
    check("max_engagement", settings.max_engagement, kLeastEngagement, kMostEngagement);
    check("grid", settings.pitch, kLeast, kMost);
    check("step", settings.spacing, kLeast, kMost);
    return settings;
}

void add_map(const Call& call, const char* name, const std::vector<double>& values)
{
    call.blocks.push_back({name, float_bytes(std::vector<float>(values.begin(), values.end()))});
}

Json map_json(const Call& call, const Verification& found)
{
    add_map(call, "left", found.left);
    add_map(call, "gouge", found.gouge);
    add_map(call, "part", found.part);
    const verify::HeightGrid& grid = found.grid;
    return {{"columns", grid.nx},
            {"rows", grid.ny},
            {"x0", grid.x0},
            {"y0", grid.y0},
            {"pitch", grid.pitch}};
}

}  // namespace

Json verify_call(Call& call)
{
    const Arguments& given = call.arguments;
    const VerifySettings settings = settings_of(given);
    const bool maps = given.flag("maps", false);
    const std::string program = given.text("program");
    call.report(0, "reading the job");
    const job::Job job = read_job_of_program(given);
    given.check_all_read();
    const Verification found = verify::verify(
        job, program, settings, [&](double share) { call.report(share, "cutting " + program); });
    Json result{{"holds", found.broken.empty()},
                {"broken", found.broken},
                {"text", verification_text(found)},
                {"stats", Json::parse(statistics_json(found))}};
    if (maps) {
        result["map"] = map_json(call, found);
    }
    return result;
}

}  // namespace cusp::engine
