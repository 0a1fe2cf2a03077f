// Feeds and speeds of a job: those of [cutting], of its tools and of its operations, within the limits of the machine
// that the job names. A material gives those that the job does not.
#pragma once

#include <filesystem>
#include <string>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/job_tools.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/material.hpp"

namespace cusp::import {

class JobRates {
public:
    // Reads `machine`, `material` and [cutting] of the job into `job`; both arguments `tools` and `job` outlive the object.
    //
    // top      of the job
    // folder   that the machine's path is relative to
    // machine  file of a machine in place of the job's, relative to the current folder; "": the job's
    //
    // Throws InputError.
    JobRates(JobTable& top,
             const std::filesystem::path& folder,
             const std::string& machine,
             JobTools& tools,
             job::Job& job);

    // The tools of an operation, with its rates. Throws InputError where one of them is beyond the machine, with the
    // key that gives it.
    void choose_tools(JobTable& table, job::Operation& operation) const;

    // chip_load of the operation, within the feed of the machine. The tools are chosen.
    void read_load(JobTable& table, job::Operation& operation) const;

private:
    void read_cutting(JobTable& top);
    void fill_in(toolpath::Tool& tool) const;
    const JobTable* giver_of(const JobTable& table,
                             const toolpath::Tool& tool,
                             const char* key) const;
    double bounded(const JobTable* giver, const char* key, double value) const;
    void check(const JobTable& table, toolpath::Tool& tool) const;

    JobTools& tools_;
    job::Job& job_;
    std::optional<job::Material> material_;
    std::optional<JobTable> cutting_;
};

}  // namespace cusp::import
