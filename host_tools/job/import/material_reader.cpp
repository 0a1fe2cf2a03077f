// One key a member of Material.
#include "host_tools/job/import/material_reader.hpp"

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/files/program_data.hpp"
#include "host_tools/job/import/data_file.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_table.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Material;
using job::OfDiameter;

namespace {

namespace fs = std::filesystem;

OfDiameter read_table(JobTable& table, const char* key)
{
    const auto pairs = table.pairs(key);
    if (pairs->empty()) {
        table.refuse(key, "is missing: [[diameter, value], ...]");
    }
    for (std::size_t k = 1; k < pairs->size(); ++k) {
        if ((*pairs)[k][0] <= (*pairs)[k - 1][0]) {
            table.refuse(key, fmt::format("the diameter {:g} does not grow from {:g}",
                                          (*pairs)[k][0], (*pairs)[k - 1][0]));
        }
    }
    return *pairs;
}

}  // namespace

Material read_material(const std::string& name, const fs::path& folder)
{
    const std::string file =
        data_file({"material", "materials", "aluminium"}, name, folder).string();
    const toml::table document = parsed_toml(files::text_of_file(file), file);
    JobTable table{document, file, "", material_table().keys};
    table.check();
    Material material;
    material.name = fs::path{file}.stem().string();
    material.source = table.text("source").value();
    material.surface_speed = table.number("surface_speed").value();
    material.chip = read_table(table, "chip");
    material.drill_speed = table.number("drill_speed").value();
    material.drill_feed = read_table(table, "drill_feed");
    table.check_all_read();
    return material;
}

}  // namespace cusp::import
