// One table a placing; the files of the operations are looked up in the raw tables, since
// operations are read after their files are placed.
#include "host_tools/job/import/placing_reader.hpp"

#include <cmath>

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

std::optional<ReliefSize> read_relief_size(JobTable& keys, double millimetres)
{
    const auto width = keys.number("width");
    const auto heights = keys.numbers("heights");
    if (!width && !heights) {
        return std::nullopt;
    }
    if (!width || !heights || heights->size() != 2) {
        keys.refuse(width ? "heights" : "width",
                    "a picture needs its width and two heights: width = 80, "
                    "heights = [-6, 0] of black and of white");
    }
    return ReliefSize{millimetres * *width, millimetres * (*heights)[0],
                      millimetres * (*heights)[1]};
}

// A grid of columns and rows, `pitch` apart.
std::vector<CopyPlace> read_grid(JobTable& keys, double millimetres)
{
    const auto grid = keys.numbers("grid");
    const auto pitch = keys.one_or_more("pitch");
    if (!grid && !pitch) {
        return {};
    }
    if (!grid || !pitch) {
        keys.refuse(grid ? "grid" : "pitch", "a grid needs both grid and pitch");
    }
    if (grid->size() != 2 || pitch->empty() || pitch->size() > 2) {
        keys.refuse(grid->size() != 2 ? "grid" : "pitch",
                    "[columns, rows] are needed, and one distance or [in x, in y]");
    }
    for (const double count : *grid) {
        if (count < 1 || count != std::floor(count) || (*grid)[0] * (*grid)[1] > kMostPlaces) {
            keys.refuse("grid",
                        fmt::format("is [{:g}, {:g}]: whole numbers from 1 are needed, {:g} "
                                    "places at most",
                                    (*grid)[0], (*grid)[1], kMostPlaces));
        }
    }
    std::vector<CopyPlace> places;
    for (int row = 0; row < static_cast<int>((*grid)[1]); ++row) {
        for (int column = 0; column < static_cast<int>((*grid)[0]); ++column) {
            places.push_back(
                {millimetres * Vec2d{column * pitch->front(), row * pitch->back()}, 0});
        }
    }
    return places;
}

std::vector<CopyPlace> read_copies(JobTable& keys, double millimetres)
{
    const auto turns = keys.one_or_more("copies_rotate");
    const auto given = keys.pairs("copies", "[x, y]");
    std::vector<CopyPlace> places = read_grid(keys, millimetres);
    if (turns && !given) {
        keys.refuse("copies_rotate", "needs copies");
    }
    if (!given) {
        return places;
    }
    if (!places.empty()) {
        keys.refuse("copies", "a placing has copies or a grid, not both");
    }
    if (given->empty() || given->size() > static_cast<std::size_t>(kMostPlaces)) {
        keys.refuse("copies",
                    fmt::format("has {} places, 1 to {:g} are needed", given->size(), kMostPlaces));
    }
    if (turns && turns->size() != 1 && turns->size() != given->size()) {
        keys.refuse("copies_rotate",
                    fmt::format("has {} numbers, 1 or {} are needed, as copies has", turns->size(),
                                given->size()));
    }
    for (std::size_t i = 0; i < given->size(); ++i) {
        const double degrees = !turns ? 0.0 : turns->size() == 1 ? turns->front() : (*turns)[i];
        places.push_back({millimetres * Vec2d{(*given)[i][0], (*given)[i][1]}, degrees});
    }
    return places;
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
        placing.relief = read_relief_size(keys, millimetres);
        placing.scale = keys.number_or_default("scale");
        placing.up = keys.choice_or_default("up");
        placing.rotate = read_turn(keys);
        placing.origin = keys.choice("origin").value_or("");
        placing.move = read_move(keys, millimetres);
        placing.copies = read_copies(keys, millimetres);
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
