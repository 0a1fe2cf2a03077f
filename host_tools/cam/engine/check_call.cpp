// A job as it is read: its faults, or what it holds.
#include <algorithm>
#include <set>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/engine/drawn_facets.hpp"

namespace cusp::engine {

using job::Job;

namespace {

Json optional(const std::optional<std::array<double, 2>>& extent)
{
    return extent ? Json(*extent) : Json(nullptr);
}

Json tools_of(const Job& job)
{
    Json out = Json::array();
    for (const toolpath::Tool& tool : job.tools) {
        const auto facts = job.tool_facts.find(tool.number);
        out.push_back({{"number", tool.number},
                       {"name", facts == job.tool_facts.end() ? "" : facts->second.name},
                       {"shape", name_of(tool.shape)},
                       {"radius", tool.radius},
                       {"corner_radius", tool.corner_radius}});
    }
    return out;
}

// The surfaces and triangles that the operations cut, each file once.
Json facets_of(const Call& call, const Job& job)
{
    std::set<std::vector<std::string>> seen;
    std::vector<nurbs::Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> triangles;
    for (const job::Operation& operation : job.operations) {
        const job::CutPart& part = operation.part;
        if (seen.insert(part.floor_files).second) {
            surfaces.insert(surfaces.end(), part.floor.begin(), part.floor.end());
            triangles.insert(triangles.end(), part.mesh.begin(), part.mesh.end());
        }
    }
    return facets_json(call, surfaces, triangles);
}

Json setup_json(const Job& job)
{
    Json operations = Json::array();
    for (const job::Operation& operation : job.operations) {
        operations.push_back({{"number", operation.number},
                              {"strategy", operation.name()},
                              {"tool", operation.tool.number}});
    }
    return {{"name", job.setup ? job.setup->name : ""},
            {"offset", job.setup ? job.setup->offset : 0},
            {"unit", job.inch ? "inch" : "mm"},
            {"stock",
             {{"x", optional(job.stock_x)},
              {"y", optional(job.stock_y)},
              {"top", job.stock_top},
              {"bottom", job.stock_bottom ? Json(*job.stock_bottom) : Json(nullptr)},
              {"clearance", job.clearance}}},
            {"tools", tools_of(job)},
            {"operations", operations}};
}

}  // namespace

Json check_call(Call& call)
{
    const bool facets = call.arguments.flag("facets", false);
    Json result{{"faults", Json::array()}, {"warnings", Json::array()}, {"setups", Json::array()}};
    std::vector<Job> setups;
    call.arguments.find_text("name");
    call.arguments.text("job");
    call.arguments.check_all_read();
    call.report(0, "reading the job");
    try {
        setups = read_setups(call.arguments);
    } catch (const InputError& error) {
        result["faults"].push_back(fault_json(error.what(), error.fault()));
        return result;
    }
    for (const Job& job : setups) {
        for (const std::string& note : job.notes) {
            result["warnings"].push_back({{"text", note}});
        }
        result["setups"].push_back(setup_json(job));
        if (facets) {
            result["setups"].back()["facets"] = facets_of(call, job);
        }
    }
    return result;
}

}  // namespace cusp::engine
