// One table a placing; the files of the operations are looked up in the raw tables, since
// operations are read after their files are placed.
#include "host_tools/job/import/placing_reader.hpp"

#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

// One number turns about z, three about x, y and z.
Vec3d read_turn(JobTable& keys)
{
    const auto turn = keys.one_or_more("rotate");
    if (!turn) {
        return {};
    }
    if (turn->size() == 1) {
        return {0, 0, turn->front()};
    }
    if (turn->size() != 3) {
        keys.refuse("rotate",
                    fmt::format("has {} numbers: degrees about z, or [x, y, z]", turn->size()));
    }
    return {(*turn)[0], (*turn)[1], (*turn)[2]};
}

Vec3d read_move(JobTable& keys, double millimetres)
{
    const auto move = keys.numbers("move");
    if (!move) {
        return {};
    }
    if (move->size() != 3) {
        keys.refuse("move", fmt::format("has {} numbers, [x, y, z] is needed", move->size()));
    }
    return millimetres * Vec3d{(*move)[0], (*move)[1], (*move)[2]};
}

// A text, or the texts of a list; anything else is refused when the operation is read.
void add_texts(const toml::table& table,
               const char* key,
               const std::filesystem::path& folder,
               std::vector<std::string>& names)
{
    const auto add = [&](const toml::node& node) {
        if (const auto name = node.value<std::string>()) {
            names.push_back(path_in(folder, *name));
        }
    };
    const toml::node* const node = table.get(key);
    if (node == nullptr) {
        return;
    }
    if (const toml::array* const list = node->as_array()) {
        for (const toml::node& each : *list) {
            add(each);
        }
    } else {
        add(*node);
    }
}

}  // namespace

std::string path_in(const std::filesystem::path& folder, const std::string& name)
{
    return std::filesystem::path{name}.is_absolute() ? name : (folder / name).string();
}

std::vector<Placing> read_placings(const std::vector<const toml::table*>& tables,
                                   const std::string& file,
                                   const std::filesystem::path& folder,
                                   double millimetres)
{
    std::vector<Placing> placings;
    for (const toml::table* const table : tables) {
        JobTable keys{*table, file, fmt::format("placing {}", placings.size() + 1),
                      placing_table().keys};
        Placing placing;
        for (const std::string& name : keys.texts("file").value_or(std::vector<std::string>{})) {
            placing.files.push_back(path_in(folder, name));
        }
        placing.scale = keys.number_or_default("scale");
        placing.up = keys.choice_or_default("up");
        placing.rotate = read_turn(keys);
        placing.origin = keys.choice("origin").value_or("");
        placing.move = read_move(keys, millimetres);
        keys.check_all_read();
        placings.push_back(placing);
    }
    return placings;
}

PlacedFiles files_of_operations(const std::vector<const toml::table*>& operations,
                                const std::filesystem::path& folder)
{
    PlacedFiles files;
    for (const toml::table* const operation : operations) {
        for (const char* const key : {"floor", "intersect"}) {
            add_texts(*operation, key, folder, files.parts);
        }
        for (const char* const key : {"boundary", "islands"}) {
            std::vector<std::string> names;
            add_texts(*operation, key, folder, names);
            for (const std::string& name : names) {
                const std::string file = name.substr(0, layer_mark(name));
                const bool is_part = is_cad_file(file) || is_mesh_file(file);
                (is_part ? files.parts : files.drawings).push_back(is_part ? file : name);
            }
        }
    }
    return files;
}

}  // namespace cusp::import
