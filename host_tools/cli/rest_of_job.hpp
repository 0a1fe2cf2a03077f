// Rest machining of the operations of a job, in the order in which they are planned.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host_tools/cam/rest_machining/rest_machining.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"

namespace cusp::cli {

class RestOfJob {
public:
    // Errors: InputError where a program can't be read or its tool is not known.
    explicit RestOfJob(const job::Job& job);

    using PlanOne = std::function<std::vector<toolpath::PlannedOperation>()>;

    // Plans an operation, and leaves in its results what is still stock after its programs and after the operations of
    // the job before it. Where that is some, the scallop is lowered by what rest machining may leave, so that the two
    // together are what the job asks for, and the operation is planned again; not where the job has a rest_tolerance.
    // What is left where the same passes were cut before is nothing.
    //
    // plan  plans the operation as it is by then
    std::vector<toolpath::PlannedOperation> rest_of(const job::Job& job,
                                                    job::Operation& operation,
                                                    const PlanOne& plan);

private:
    // False where nothing is left.
    bool keep(const job::Job& job,
              const job::Operation& operation,
              std::vector<toolpath::PlannedOperation>& results);
    bool lower_scallop(const job::Job& job, job::Operation& operation) const;
    std::vector<std::string> programs_before(const job::Job& job,
                                             const job::Operation& operation) const;

    std::map<std::string, std::vector<verify::EarlierCut>> cuts_;  // by program
    std::map<int, rest_machining::RestTolerance> tolerances_;      // by the number of the operation
    std::vector<toolpath::Toolpath> paths_;                        // of the job so far
};

}  // namespace cusp::cli
