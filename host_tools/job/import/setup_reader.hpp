// The tables [[setup]] of a job, and which of its operations and fixtures are in which.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/similarity.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

class SetupTables {
public:
    // Reads the key `setup` of the job.
    //
    // file            of the job, for messages
    // operation_keys  of all strategies
    //
    // Errors, here and below: InputError with line and key. Here: a name that is missing, taken or no word,
    // an offset that is taken.
    SetupTables(JobTable& top,
                const std::string& file,
                const std::vector<job::Key>& operation_keys);

    // In order; none where the job has no such table.
    const std::vector<job::Setup>& all() const { return setups_; }

    // The place among all() that the key `setup` of an operation or a fixture names; without the key that of
    // the first. Refused where it names none.
    std::size_t place_of(JobTable& table) const;

    // As place_of(), read from the operation before it is read as a whole.
    //
    // index  the operation's place in the job, from 1
    std::size_t place_of(const toml::table& operation, std::size_t index) const;

    // Refuses a set-up that none of the operations is in.
    void check_used(const std::vector<const toml::table*>& operations) const;

    // The motion by which a flip takes points of the drawn part: about the middle of the stock's
    // box. The identity without a flip.
    //
    // job      with its stock's box
    // has_top  whether the job gives the stock's top
    //
    // Errors: a flip where the stock's box is not given.
    Similarity turn_of(const job::Setup& setup, const job::Job& job, bool has_top) const;

private:
    std::string names() const;

    std::string file_;
    std::vector<job::Key> operation_keys_;
    std::vector<job::Setup> setups_;
};

}  // namespace cusp::import
