// Rest machining of the operations of a job, in the order in which they are planned.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host_tools/cam/rest_machining/rest_machining.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"

namespace cusp::plan {

// An operation is planned as it is first. If some stock is left for it, its scallop is lowered by what rest machining
// may leave, so that the two together are what the job asks for, and it is planned again. Nothing is left where the same
// passes were cut before.
class RestOfJob {
public:
    RestOfJob() = default;
    // Errors: InputError if a program can't be read or its tool is not known.
    explicit RestOfJob(const job::Job& job);

    // Leaves in the results of an operation what is still stock after its programs and after the operations
    // remembered; threads as a whole. False if nothing is left, or the job has no earlier programs.
    bool keep(const job::Job& job,
              const job::Operation& operation,
              std::vector<toolpath::PlannedOperation>& results) const;

    // Lowers the scallop by what rest machining may leave. False if the operation has a rest_tolerance, or too small a
    // scallop.
    bool lower_scallop(const job::Job& job, job::Operation& operation) const;

    // Operations to come are after this one.
    void remember(const std::vector<toolpath::PlannedOperation>& results);

private:
    std::vector<std::string> programs_before(const job::Job& job,
                                             const job::Operation& operation) const;

    std::map<std::string, std::vector<verify::EarlierCut>> cuts_;  // by program
    std::map<int, rest_machining::RestTolerance> tolerances_;      // by the number of the operation
    std::vector<toolpath::Toolpath> paths_;                        // of the job so far
};

}  // namespace cusp::plan
