// The table [stock] of a job.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// The programs that a key names, of programs that have been cut before; none where it is absent.
// Throws InputError where one is no file.
//
// folder  that they are relative to
std::vector<std::string> read_programs(JobTable& table,
                                       const char* key,
                                       const std::filesystem::path& folder);

class StockTable {
public:
    // Takes what needs no part.
    //
    // table        [stock]; null: the job has none
    // file         of the job, for messages
    // folder       that programs are relative to
    // millimetres  of one unit of the job
    //
    // Errors, here and below: InputError with line, key, value and limit.
    StockTable(const toml::table* table,
               const std::string& file,
               const std::filesystem::path& folder,
               double millimetres,
               job::Job& job);

    // Takes the loops of `outline` as the files lie by now.
    void read_outline(PartFiles& parts, job::Job& job) const;

    // Takes what follows from the parts: their top, margins round them.
    //
    // job  with all its operations
    void settle(job::Job& job) const;

    // The drawing of `outline`, with its layer; empty: the table has none.
    const std::string& outline() const { return outline_; }

    // True if the table has the top.
    bool has_top() const { return top_.has_value(); }

private:
    void settle_sides(job::Job& job) const;
    void settle_heights(job::Job& job) const;
    void check_pockets(const job::Job& job) const;

    JobTable keys_;
    std::string outline_;
    std::optional<double> top_;
    std::optional<std::array<double, 2>> margin_;  // mm, in x and in y
    std::optional<double> margin_top_;
    std::optional<double> margin_bottom_;
};

}  // namespace cusp::import
