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
    const auto turn = keys.numbers("rotate");
    return !turn               ? Vec3d{}
           : turn->size() == 1 ? Vec3d{0, 0, turn->front()}
                               : Vec3d{(*turn)[0], (*turn)[1], (*turn)[2]};
}

std::optional<ReliefSize> read_relief_size(JobTable& keys)
{
    const auto width = keys.number("width");
    const auto heights = keys.point("heights");
    return width ? std::optional{ReliefSize{*width, heights->x, heights->y}} : std::nullopt;
}

// A grid of columns and rows, `pitch` apart.
std::vector<CopyPlace> read_grid(JobTable& keys)
{
    const auto grid = keys.numbers("grid");
    const auto pitch = keys.numbers("pitch");
    if (!grid) {
        return {};
    }
    if (grid->size() != 2) {
        keys.refuse("grid", "[columns, rows] are needed");
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
            places.push_back({Vec2d{column * pitch->front(), row * pitch->back()}, 0});
        }
    }
    return places;
}

std::vector<CopyPlace> read_copies(JobTable& keys)
{
    const auto turns = keys.numbers("copies_rotate");
    const auto given = keys.pairs("copies");
    std::vector<CopyPlace> places = read_grid(keys);
    if (!given) {
        return places;
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
        places.push_back({Vec2d{(*given)[i][0], (*given)[i][1]}, degrees});
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

std::vector<Placing> read_placings(JobTable& top, const std::filesystem::path& folder)
{
    std::vector<Placing> placings;
    for (JobTable& keys : top.each("placing", placing_table())) {
        Placing placing;
        for (const std::string& name : keys.all_texts("file")) {
            placing.files.push_back(path_in(folder, name));
        }
        placing.relief = read_relief_size(keys);
        placing.scale = keys.number_or_default("scale");
        placing.up = keys.choice_or_default("up");
        placing.rotate = read_turn(keys);
        placing.origin = keys.choice("origin").value_or("");
        if (const auto move = keys.numbers("move")) {
            placing.move = {(*move)[0], (*move)[1], (*move)[2]};
        }
        placing.copies = read_copies(keys);
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
