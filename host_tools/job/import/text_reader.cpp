// A text is drawn where it is read; then it is a drawing like any other.
#include "host_tools/job/import/text_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "host_tools/job/import/lettering.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/placing_reader.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

namespace fs = std::filesystem;

bool is_font_file(const std::string& file)
{
    const std::string ending = path_ending(file);
    return ending == ".ttf" || ending == ".otf";
}

std::vector<fs::path> font_folders()
{
    std::vector<fs::path> folders;
    if (const char* const home = std::getenv("HOME")) {
        folders.push_back(fs::path{home} / ".local/share/fonts");
        folders.push_back(fs::path{home} / ".fonts");
    }
    folders.emplace_back("/usr/local/share/fonts");
    folders.emplace_back("/usr/share/fonts");
    return folders;
}

// The font of that name in the first folder that has it; of several there, the first in order of their paths.
std::string font_of_name(const std::string& name)
{
    for (const fs::path& folder : font_folders()) {
        std::vector<std::string> found;
        std::error_code failed;
        fs::recursive_directory_iterator at{folder, fs::directory_options::skip_permission_denied,
                                            failed};
        for (; !failed && at != fs::recursive_directory_iterator{}; at.increment(failed)) {
            if (at->path().stem() == name && is_font_file(at->path().string())) {
                found.push_back(at->path().string());
            }
        }
        if (!found.empty()) {
            return *std::min_element(found.begin(), found.end());
        }
    }
    return {};
}

std::string font_file(JobTable& table, const fs::path& folder)
{
    const auto font = table.text("font");
    if (!font) {
        return {};
    }
    if (is_font_file(*font)) {
        return path_in(folder, *font);
    }
    const std::string file = font_of_name(*font);
    if (file.empty()) {
        table.refuse(
            "font",
            fmt::format("\"{}\" is neither a file (.ttf, .otf) nor the name of one among the "
                        "system's fonts; without font letters are single lines",
                        *font));
    }
    return file;
}

}  // namespace

std::optional<std::string> read_text(JobTable& table,
                                     const fs::path& folder,
                                     const job::Operation& operation,
                                     PartFiles& parts)
{
    const auto text = table.text("text");
    if (!text) {
        table.leave({"font", "size", "at", "align", "angle", "arc"});
        return std::nullopt;
    }
    Lettering lettering;
    lettering.font_file = font_file(table, folder);
    lettering.size = table.number("size").value();
    lettering.at = table.point("at").value_or(Vec2d{0, 0});
    lettering.align =
        *table.chosen("align", {TextAlign::kLeft, TextAlign::kCentre, TextAlign::kRight});
    lettering.angle = table.number_or_default("angle");
    lettering.arc = table.number("arc").value_or(0);
    lettering.text = *text;
    const std::string name = fmt::format("operation {}: text", operation.number);
    parts.draw(name, {paths_of_text(lettering, name), 0});
    return name;
}

}  // namespace cusp::import
