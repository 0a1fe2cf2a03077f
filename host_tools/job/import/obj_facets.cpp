// A statement a line: "v" is a vertex, "f" a face; a backslash at its end joins the next line.
#include "host_tools/job/import/obj_facets.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/import/polygon_triangles.hpp"

namespace cusp::import {
using number_text::number_of;

namespace {

constexpr const char* kBlanks = " \t\r\\\n";

class ObjReader {
public:
    ObjReader(std::string file, double unit) : file_{std::move(file)}, unit_{unit} {}

    Facets read(std::string_view text)
    {
        while (!text.empty()) {
            std::size_t end = text.find('\n');
            int lines = 1;
            while (end != std::string_view::npos && ends_in_backslash(text.substr(0, end))) {
                end = text.find('\n', end + 1);
                ++lines;
            }
            read_statement(text.substr(0, end));
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
            line_ += lines;
        }
        return std::move(facets_);
    }

private:
    static bool ends_in_backslash(std::string_view line)
    {
        const std::size_t last = line.find_last_not_of('\r');
        return last != std::string_view::npos && line[last] == '\\';
    }

    void read_statement(std::string_view statement)
    {
        rest_ = statement;
        const std::string_view keyword = next();
        if (keyword == "v") {
            read_vertex();
        } else if (keyword == "f") {
            read_face();
        }
    }

    void read_vertex()
    {
        Vec3d at{};
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::string_view word = next();
            const auto value = number_of(word);
            if (!value) {
                refuse(word, "a number is needed");
            }
            at[axis] = *value;
        }
        vertices_.push_back(unit_ * at);
        check_corner(vertices_.back(), [&] { return place(); });
    }

    void read_face()
    {
        std::vector<Vec3d> polygon;
        for (std::string_view word = next(); !word.empty(); word = next()) {
            polygon.push_back(vertex_of(word));
        }
        if (polygon.size() < 3) {
            throw InputError(fmt::format("{}: a face has {} corners, at least 3 are needed",
                                         place(), polygon.size()));
        }
        for (const auto& triangle : polygon_triangles(polygon)) {
            add_facet(triangle, facets_);
        }
    }

    // "7", "7/1/3" or "-1": from 1, or back from the last vertex so far.
    Vec3d vertex_of(std::string_view word) const
    {
        const std::string_view digits = word.substr(0, word.find('/'));
        const char* end = digits.data() + digits.size();
        long long number = 0;
        const auto [stop, error] = std::from_chars(digits.data(), end, number);
        const auto count = static_cast<long long>(vertices_.size());
        const long long index = number < 0 ? count + number : number - 1;
        if (error != std::errc{} || stop != end || digits.empty() || index < 0 || index >= count) {
            refuse(word, fmt::format("a vertex is needed, 1 to {} so far", count));
        }
        return vertices_[static_cast<std::size_t>(index)];
    }

    // "" at the end of the statement, and where a comment begins.
    std::string_view next()
    {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
        rest_.remove_prefix(word.size());
        if (!word.empty() && word[0] == '#') {
            rest_ = {};
            return {};
        }
        return word;
    }
    std::string place() const { return fmt::format("{}:{}", file_, line_); }
    [[noreturn]] void refuse(std::string_view word, const std::string& needed) const
    {
        throw InputError(word.empty() ? fmt::format("{}: cut short: {}", place(), needed)
                                      : fmt::format("{}: \"{}\" found, {}", place(),
                                                    word.substr(0, 40), needed));
    }

    std::string file_;
    double unit_;
    int line_{1};
    std::string_view rest_;
    std::vector<Vec3d> vertices_;
    Facets facets_;
};

}  // namespace

Facets read_obj(const std::string& file, double millimetres)
{
    const std::string text = files::text_of_file(file);
    return ObjReader{file, millimetres}.read(files::without_byte_order_mark(text));
}

}  // namespace cusp::import
