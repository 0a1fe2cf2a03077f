// Clearance between tools and the fixtures of a job, and links that are raised over fixtures.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// mm from a fixture grown by its margin to a tool with its tip at `tip`, a vertical cylinder of the
// tool's radius. At most 0 where they touch; over a rim a lower bound of the distance.
double distance_to(const Fixture& fixture, double tool_radius, Vec3d tip);

struct FixtureHit {
    std::size_t fixture;  // of the job
    Vec3d tip;
};

// A point of the move where the tool enters a grown fixture by 1e-3 mm or more; curves are chords
// within that.
std::optional<FixtureHit> fixture_hit(const Job& job,
                                      double tool_radius,
                                      Vec3d from,
                                      const toolpath::ToolMove& move);

// Leads links that would touch a grown fixture over it: up to the clearance, across, and down at
// the plunge feed to where the link ends. Returns how many.
//
// operation  for messages
//
// Errors: InputError where any other move touches one: fixture, place, operation.
int keep_off_fixtures(const Job& job, const std::string& operation, toolpath::Toolpath& path);

}  // namespace cusp::job
