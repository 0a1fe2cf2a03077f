// The tools that a job may use: its own, and those of its library that its operations name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/tool_reader.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

class JobTools {
public:
    // top     of the job: its keys tool and library are read
    // folder  that the library's path is relative to
    //
    // Throws InputError where there is no tool, or a library can't be read.
    JobTools(JobTable& top, const std::filesystem::path& folder);

    // True if every tool has a feed of its own.
    bool has_feeds() const;

    // The tool that the key `tool` of an operation names, by number or name; without it the job's
    // first. Throws InputError with the nearest names, or where the job has no tool of its own.
    toolpath::Tool tool(JobTable& table);

    // Those that its key `tools` names; empty where it is absent.
    std::vector<toolpath::Tool> tools(JobTable& table);

    // The keys and the facts of the tool with that number, which has been chosen.
    const JobTable& table_of(int number) const { return chosen(number).table; }
    const job::ToolFacts& facts_of(int number) const { return chosen(number).read.facts; }

    // Puts the job's own tools, those chosen, and their facts into the job.
    void store(job::Job& job) const;

private:
    struct Entry {
        ReadTool read;
        bool used;
        JobTable table;
    };
    static void read_tables(JobTable& top, std::vector<Entry>& entries);
    void read_library(const std::string& name, const std::filesystem::path& folder);
    const Entry& chosen(int number) const;
    Entry& by_number(const JobTable& table, const char* key, int number);
    Entry& by_name(const JobTable& table, const char* key, const std::string& name);
    const toolpath::Tool& use(const JobTable& table, const char* key, Entry& entry);

    toml::table library_document_;
    std::vector<Entry> own_;
    std::vector<Entry> library_;
    std::string library_file_;
};

}  // namespace cusp::import
