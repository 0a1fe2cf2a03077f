// The loops of a face within one cell of its surface: an octant of a sphere, a sector of a ring.
//
// Edges are cut where they leave a cell. Cut edges and stretches of the cell's boundary in turn are the
// loops, after Weiler and Atherton: where an edge leaves, the way along the boundary, which runs
// counter-clockwise, leads to the next edge that enters.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host_tools/job/import/face_edges.hpp"

namespace cusp::import {

// An edge within one cell.
struct CellEdge {
    FaceEdge edge;
    bool enters;  // begins in the cell's boundary
    bool leaves;  // ends there
    bool used;
};

// The parts of an edge that cross no boundary. `cell_of` is the number of a point's cell along one of
// `axes` directions, in which the boundaries of cells are independent.
std::vector<CellEdge> cut_at_cells(const FaceEdge& edge,
                                   unsigned axes,
                                   const std::function<int(Vec3d point, unsigned axis)>& cell_of);

// The boundary of a cell, counter-clockwise from outside: sides from corner to corner.
class CellBoundary {
public:
    explicit CellBoundary(unsigned sides) : sides_{sides} {}
    virtual ~CellBoundary() = default;

    // Distance of a point beside a side, to compare; its place along it, 0 to 1 from corner to
    // corner.
    virtual double beside(Vec3d point, unsigned side) const = 0;
    virtual double along(Vec3d point, unsigned side) const = 0;
    // A part of a side, 0 to 1.
    virtual FaceEdge part(unsigned side, double from, double to) const = 0;
    // The distance of two points, in the unit of `gap` in cell_loops().
    virtual double distance(Vec3d a, Vec3d b) const = 0;

    unsigned sides() const { return sides_; }
    // 0 to the number of sides, of a point on a side.
    double place_of(Vec3d point) const;
    // The sides from one place counter-clockwise to another one; once round where these are equal.
    FaceLoop between(double from, double to) const;

protected:
    CellBoundary(const CellBoundary&) = default;
    CellBoundary& operator=(const CellBoundary&) = default;

private:
    unsigned sides_;
};

// edges      those within the cell
// is_inside  whether a point belongs to the face; asked on the boundary, where no edge meets that
// gap        how far ends that meet within the cell may lie apart
// place      begins the message
//
// Returns closed loops; what they enclose lies on their left. None: no part of the face.
// Errors: InputError where edges do not close, bound no face, or are said to bound both of their sides.
std::vector<FaceLoop> cell_loops(std::vector<CellEdge> edges,
                                 const CellBoundary& boundary,
                                 const std::function<bool(Vec3d)>& is_inside,
                                 double gap,
                                 const std::string& place);

}  // namespace cusp::import
