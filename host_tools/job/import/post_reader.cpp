// One key a member of Post.
#include "host_tools/job/import/post_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "host_tools/base/files/files.hpp"
#include "host_tools/job/import/data_file.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_table.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using toolpath::ArcForm;
using toolpath::CommentForm;
using toolpath::Post;

namespace {

namespace fs = std::filesystem;

constexpr DataKind kPosts{"post", "posts", "cusp"};
constexpr std::size_t kLongestLine = 200;

// A list of lines, and the fields that its lines may have.
struct LineKey {
    const char* key;
    std::vector<std::string> Post::*lines;
    std::vector<std::string> fields;
};

const std::vector<LineKey>& line_keys()
{
    static const std::vector<std::string> kOfTool{"tool", "comment", "clearance"};
    static const std::vector<LineKey> kKeys{
        {"begin", &Post::begin, {}},
        {"modes", &Post::modes, {"units", "offset", "clearance"}},
        {"exact_path", &Post::exact_path, {}},
        {"blend", &Post::blend, {"tolerance"}},
        {"header", &Post::header, {}},
        {"first_tool", &Post::first_tool, kOfTool},
        {"next_tool", &Post::next_tool, kOfTool},
        {"spindle_on", &Post::spindle_on, {"rpm"}},
        {"mist", &Post::mist, {}},
        {"flood", &Post::flood, {}},
        {"coolant_off", &Post::coolant_off, {}},
        {"after_tool", &Post::after_tool, {"tool", "clearance"}},
        {"footer", &Post::footer, {}},
        {"end", &Post::end, {}},
    };
    return kKeys;
}

void check_line(const JobTable& table, const LineKey& key, const std::string& line)
{
    const auto printable = [](char c) {
        return c >= ' ' && c <= '~';
    };
    if (line.empty() || line.size() > kLongestLine ||
        !std::all_of(line.begin(), line.end(), printable)) {
        table.refuse(key.key, fmt::format("a line has 1 to {} printable ASCII characters, this "
                                          "one {} bytes",
                                          kLongestLine, line.size()));
    }
    for (std::size_t at = line.find('{'); at != std::string::npos; at = line.find('{', at + 1)) {
        const std::size_t end = line.find('}', at);
        const std::string field = end == std::string::npos ? "" : line.substr(at + 1, end - at - 1);
        if (std::find(key.fields.begin(), key.fields.end(), field) == key.fields.end()) {
            table.refuse(key.key, fmt::format("{} in \"{}\" is no field of it{}{}",
                                              end == std::string::npos ? "{" : "{" + field + "}",
                                              line, key.fields.empty() ? "" : "; known are: ",
                                              fmt::join(key.fields, ", ")));
        }
    }
}

Post post_of(const toml::table& document, const std::string& file, const std::string& name)
{
    JobTable table{document, file, "", post_table().keys};
    table.check();
    Post post;
    post.name = name;
    post.about = table.text("about").value_or("a controller of its own file");
    post.mm_decimals = table.whole_number("mm_decimals").value();
    post.inch_decimals = table.whole_number("inch_decimals").value();
    post.arcs = *table.chosen("arcs", {ArcForm::kCentre, ArcForm::kRadius, ArcForm::kNone});
    post.comments = *table.chosen(
        "comments", {CommentForm::kParentheses, CommentForm::kSemicolon, CommentForm::kNone});
    post.nurbs = table.flag("nurbs").value();
    post.drill_cycles = table.flag_or_default("drill_cycles");
    post.point = table.flag("point").value();
    post.rapid_feed = table.number_or_default("rapid_feed");
    post.line_numbers = table.whole_number_or_default("line_numbers");
    for (const LineKey& key : line_keys()) {
        post.*key.lines = table.all_texts(key.key);
        for (const std::string& line : post.*key.lines) {
            check_line(table, key, line);
        }
    }
    table.check_all_read();
    return post;
}

Post post_in(const fs::path& file, const std::string& name)
{
    const toml::table document = parsed_toml(files::text_of_file(file.string()), file.string());
    return post_of(document, file.string(), name);
}

// "T M6, G43 H" of the words that the lines hold, in their order.
std::string words_among(const std::vector<std::string>& words,
                        const std::vector<std::vector<std::string>>& lines)
{
    std::vector<std::string> found;
    for (const std::string& word : words) {
        const auto has_word = [&](const std::string& line) {
            const std::string text = " " + line + " ";
            const std::size_t at = text.find(" " + word);
            return at != std::string::npos &&
                   std::isdigit(static_cast<unsigned char>(text[at + 1 + word.size()])) == 0;
        };
        for (const std::vector<std::string>& some : lines) {
            if (std::any_of(some.begin(), some.end(), has_word)) {
                found.push_back(word);
                break;
            }
        }
    }
    return fmt::format("{}", fmt::join(found, " "));
}

}  // namespace

std::string post_text(const Post& post)
{
    const std::string arcs = post.arcs == ArcForm::kCentre   ? "G2 G3 I J K"
                             : post.arcs == ArcForm::kRadius ? "G2 G3 R"
                                                             : "no arcs";
    const std::string tool =
        words_among({"T", "M6", "M06", "G43", "M0", "M600"}, {post.next_tool, post.after_tool});
    const std::string path = words_among({"G61", "G64", "P"}, {post.exact_path, post.blend});
    std::vector<std::string> parts{
        fmt::format("{} and {} decimals (mm, inches)", post.mm_decimals, post.inch_decimals), arcs};
    if (post.nurbs) {
        parts.emplace_back("NURBS G6.2");
    }
    if (post.drill_cycles) {
        parts.emplace_back("holes G81 G83");
    }
    parts.push_back("tool change " + tool);
    parts.push_back(path.empty() ? "no path modes" : path);
    const std::string coolant = words_among({"M7", "M8", "M08"}, {post.mist, post.flood});
    parts.push_back(coolant.empty() ? "no coolant" : "coolant " + coolant);
    return fmt::format("{}\n    {}", post.about, fmt::join(parts, "; "));
}

std::vector<std::string> post_names() { return data_names(kPosts); }

std::vector<Post> all_posts()
{
    std::vector<Post> posts;
    for (const std::string& name : data_names_or_refuse(kPosts)) {
        posts.push_back(read_post(name, ""));
    }
    return posts;
}

Post read_post(const std::string& name, const fs::path& folder)
{
    if (name == kPosts.always) {
        return {};
    }
    const fs::path file = data_file(kPosts, name, folder);
    return post_in(file, file.stem().string());
}

}  // namespace cusp::import
