// Finds tools by number and by name.
#include "host_tools/job/import/job_tools.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/data_file.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/nearest_name.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Job;
using toolpath::Tool;

namespace {

namespace fs = std::filesystem;

constexpr DataKind kLibraries{"library", "tool_libraries", "wood"};
constexpr std::size_t kNearest = 3;

}  // namespace

JobTools::JobTools(JobTable& top, const fs::path& folder)
{
    read_tables(top, own_);
    for (Entry& entry : own_) {
        entry.used = true;
    }
    if (const auto library = top.text("library")) {
        top.blamed("library", [&] { read_library(*library, folder); });
    } else if (own_.empty()) {
        top.refuse("tool", "is missing: a table [tool] or several [[tool]]");
    }
}

void JobTools::read_tables(JobTable& top, std::vector<Entry>& entries)
{
    for (JobTable& keys : top.each("tool", tool_table())) {
        const ReadTool read = read_tool(keys, entries.size() + 1);
        for (const Entry& other : entries) {
            if (!read.facts.name.empty() && other.read.facts.name == read.facts.name) {
                keys.refuse("name", fmt::format("two tools are named \"{}\"", read.facts.name));
            }
            if (other.read.tool.number == read.tool.number) {
                keys.refuse("number",
                            fmt::format("two tools have the number {}", read.tool.number));
            }
        }
        entries.push_back({read, false, keys});
    }
}

void JobTools::read_library(const std::string& name, const fs::path& folder)
{
    library_file_ = data_file(kLibraries, name, folder).string();
    library_document_ = parsed_toml(files::text_of_file(library_file_), library_file_);
    JobTable top{library_document_, library_file_, "", library_table().keys};
    top.take_unit();
    top.check();
    read_tables(top, library_);
    for (const Entry& entry : library_) {
        if (entry.read.facts.name.empty()) {
            entry.table.refuse("name", "is missing: operations name the tools of a library");
        }
    }
}

bool JobTools::has_feeds() const
{
    const auto has_feed = [](const Entry& entry) {
        return entry.read.tool.rates.feed > 0;
    };
    return std::all_of(own_.begin(), own_.end(), has_feed) &&
           std::all_of(library_.begin(), library_.end(), has_feed);
}

JobTools::Entry& JobTools::by_number(const JobTable& table, const char* key, int number)
{
    for (std::vector<Entry>* entries : {&own_, &library_}) {
        for (Entry& entry : *entries) {
            if (entry.read.tool.number == number) {
                return entry;
            }
        }
    }
    table.refuse(key, fmt::format("is {}, no [[tool]] has that number", number));
}

JobTools::Entry& JobTools::by_name(const JobTable& table, const char* key, const std::string& name)
{
    std::vector<std::string> names;
    for (std::vector<Entry>* entries : {&own_, &library_}) {
        for (Entry& entry : *entries) {
            if (entry.read.facts.name == name) {
                return entry;
            }
            if (!entry.read.facts.name.empty()) {
                names.push_back(entry.read.facts.name);
            }
        }
    }
    if (names.empty()) {
        table.refuse(key, fmt::format("is \"{}\", but no tool has a name", name));
    }
    table.refuse(key,
                 fmt::format("is \"{}\", no tool has that name{}; the nearest are \"{}\"", name,
                             library_file_.empty() ? "" : ", in " + library_file_ + " either",
                             fmt::join(nearest_names(name, names, kNearest), "\", \"")));
}

// A tool of the library is known by its number in the program: the job's own must not have it.
const Tool& JobTools::use(const JobTable& table, const char* key, Entry& entry)
{
    const Tool& tool = entry.read.tool;
    for (const Entry& own : own_) {
        if (&own != &entry && own.read.tool.number == tool.number) {
            table.refuse(key, fmt::format("the library's tool \"{}\" has the number {}, and so has "
                                          "a [[tool]] of the job: give that another number",
                                          entry.read.facts.name, tool.number));
        }
    }
    entry.used = true;
    return tool;
}

Tool JobTools::tool(JobTable& table)
{
    constexpr const char* kKey = "tool";
    if (table.is_text(kKey)) {
        return use(table, kKey, by_name(table, kKey, *table.text(kKey)));
    }
    if (const auto number = table.whole_number(kKey)) {
        return use(table, kKey, by_number(table, kKey, *number));
    }
    if (own_.empty()) {
        table.refuse(kKey, "is missing: name a tool of the library " + library_file_);
    }
    return own_.front().read.tool;
}

std::vector<Tool> JobTools::tools(JobTable& table)
{
    constexpr const char* kKey = "tools";
    std::vector<Tool> tools;
    const auto add = [&](Entry& entry) {
        const Tool& tool = use(table, kKey, entry);
        for (const Tool& other : tools) {
            if (other.number == tool.number) {
                table.refuse(kKey, fmt::format("holds tool {} twice", tool.number));
            }
        }
        tools.push_back(tool);
    };
    if (table.is_text(kKey)) {
        for (const std::string& name : table.all_texts(kKey)) {
            add(by_name(table, kKey, name));
        }
        return tools;
    }
    const auto numbers = table.numbers(kKey);
    for (const double number : numbers.value_or(std::vector<double>{})) {
        if (number != std::floor(number)) {
            table.refuse(kKey, fmt::format("holds {:g}, whole numbers are needed", number));
        }
        add(by_number(table, kKey, static_cast<int>(number)));
    }
    if (numbers && tools.empty()) {
        table.refuse(kKey, "names no tool");
    }
    return tools;
}

const JobTools::Entry& JobTools::chosen(int number) const
{
    const auto is_it = [&](const Entry& entry) {
        return entry.used && entry.read.tool.number == number;
    };
    const auto own = std::find_if(own_.begin(), own_.end(), is_it);
    return own != own_.end() ? *own : *std::find_if(library_.begin(), library_.end(), is_it);
}

void JobTools::store(Job& job) const
{
    for (const std::vector<Entry>* entries : {&own_, &library_}) {
        for (const Entry& entry : *entries) {
            if (entry.used) {
                job.tools.push_back(entry.read.tool);
                job.tool_facts[entry.read.tool.number] = entry.read.facts;
            }
        }
    }
}

}  // namespace cusp::import
