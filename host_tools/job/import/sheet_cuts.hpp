// Sorts the shapes of drawings into the operations that cut them.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/one_line_choice.hpp"

namespace cusp::import {

// One operation of the job.
struct SheetCut {
    int rank{};        // operations of a lower one come first
    std::string toml;  // the table
    std::string said;  // in words: what is cut, how, and how deep
};

// In the order in which they are cut.
//
// choice  tools and unit
//
// Errors: InputError, as sheet_job().
std::vector<SheetCut> sheet_cuts(const OneLineRequest& request,
                                 const OneLineChoice& choice,
                                 const job::Strategies& strategies,
                                 PartFiles& parts);

}  // namespace cusp::import
