// Passes of an operation, what they leave, and the passes that are missing between them.
//
//     FinishCompletion passes{job, operation, work};
//     passes.cut(tips);                  // planes, levels
//     return passes.finished(step);      // the rest of the passes, links, the proved scallop
#pragma once

#include <vector>

#include "host_tools/cam/finishing/surface_operation.hpp"

namespace cusp::steep_shallow {

class FinishCompletion {
public:
    // job, operation, work  kept
    FinishCompletion(const job::Job& job,
                     const job::Operation& operation,
                     finishing::SurfaceOperation& work)
        : job_{job}, operation_{operation}, work_{work}
    {
    }

    // Adds a pass through dense tips, with their contacts if known.
    void cut(const finishing::Points& tips, const finishing::CcParameterList& cc_parameters = {});
    void cut(finishing::SurfaceOperation::FittedPass pass);

    // Links all passes. With `step_over` the scallop that they keep is proved; else the passes are
    // added that the scallop lacks.
    //
    // step     mm: of neighbouring passes
    // lead_in  mm: radius of level entries and exits
    toolpath::PlannedOperation finished(double step, double lead_in = 0);

private:
    void prove(double step);
    void complete_surfaces();
    void complete_mesh();
    void report(double from, double to, double share) const;

    const job::Job& job_;
    const job::Operation& operation_;
    finishing::SurfaceOperation& work_;
    std::vector<finishing::Points> cut_;
    double bound_{};         // mm: of the scallop
    double beside_edges_{};  // mm
    finishing::MeshLeft left_;
};

// Share of the progress at which all planes and levels are made.
inline constexpr double kSectionsDone = 0.5;

// Errors: a scallop or a step_over that is too large for the tool, neither of them.
void check_sizes(const job::Job& job, const job::Operation& operation);

}  // namespace cusp::steep_shallow
