#include "host_tools/job/part_info/part_info.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/job/part_info/mesh_places.hpp"
#include "host_tools/job/part_info/surface_facets.hpp"

namespace cusp::part_info {

using job::PartGeometry;
using part_model::PartModel;

namespace {

// Largest ball that is tried, in diagonals of the part.
constexpr double kLargestBall = 5;
constexpr std::size_t kBallPlaces = 20000;
// Fraction of the tolerance that the facets for trial balls may deviate from the faces.
constexpr double kFacetShare = 0.25;

TopOfPart top_of(const PartModel& mesh)
{
    return [&mesh](double x, double y) {
        const auto found = mesh.height_at(x, y);
        return found ? std::optional{found->point.z} : std::nullopt;
    };
}

std::vector<char> hidden_points(const TopOfPart& top, const std::vector<GroundPlace>& places)
{
    std::vector<char> hidden;
    hidden.reserve(places.size());
    for (const GroundPlace& place : places) {
        hidden.push_back(hidden_from_above(top, place) ? 1 : 0);
    }
    return hidden;
}

// An even selection of about `max_count` points that are not hidden.
void add_seen(const std::vector<GroundPlace>& places,
              const std::vector<char>& hidden,
              std::size_t max_count,
              std::vector<GroundPlace>& seen)
{
    const std::size_t step = std::max<std::size_t>(1, places.size() / max_count);
    for (std::size_t k = 0; k < places.size(); k += step) {
        if (hidden[k] == 0) {
            seen.push_back(places[k]);
        }
    }
}

double largest_asked_for(const PartInfo& info)
{
    return kLargestBall * norm(info.part.box_high - info.part.box_low);
}

void inspect_surfaces(PartInfo& info, double tolerance)
{
    info.pieces = info.part.surfaces.size();
    const SurfacePlaces found = surface_places(info.part.surfaces, info.part.outwards);
    const SurfaceFacets facets = surface_facets(info.part.surfaces, kFacetShare * tolerance);
    const PartModel model{facets.triangles};
    const std::vector<char> hidden = hidden_points(top_of(model), found.places);
    info.ground = ground_of(found.places, hidden, info.part.box_low.z);
    info.hollow = smallest_hollow(info.part.surfaces, found, hidden);
    std::vector<GroundPlace> seen;
    if (info.hollow) {
        seen.push_back(info.hollow->place);
    }
    add_seen(found.places, hidden, kBallPlaces, seen);
    info.ball = largest_ball(model, seen, std::max(tolerance, facets.tolerance / kFacetShare),
                             facets.tolerance, facets.triangles.size(), largest_asked_for(info));
}

void inspect_mesh(PartInfo& info, double tolerance)
{
    info.pieces = info.part.triangles.size();
    std::vector<GroundPlace> places;
    std::vector<GroundPlace> creases;
    {
        const WeldedMesh mesh = weld(info.part.triangles);
        info.mesh = mesh.health;
        places = facet_places(mesh);
        creases = crease_places(mesh, kBallPlaces);
    }
    const PartModel model{info.part.triangles};
    const TopOfPart top = top_of(model);
    const std::vector<char> hidden = hidden_points(top, places);
    info.ground = ground_of(places, hidden, info.part.box_low.z);
    std::vector<GroundPlace> seen;
    add_seen(creases, hidden_points(top, creases), 2 * kBallPlaces, seen);
    add_seen(places, hidden, kBallPlaces, seen);
    info.ball = largest_ball(model, seen, tolerance, 0, info.pieces, largest_asked_for(info));
}

}  // namespace

PartInfo inspect_part(PartGeometry part, double tolerance)
{
    PartInfo info;
    info.part = std::move(part);
    if (!info.part.triangles.empty()) {
        inspect_mesh(info, tolerance);
    } else if (!info.part.surfaces.empty()) {
        inspect_surfaces(info, tolerance);
    }
    return info;
}

}  // namespace cusp::part_info
