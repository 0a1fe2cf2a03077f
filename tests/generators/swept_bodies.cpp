#include "tests/generators/swept_bodies.hpp"

#include <cmath>

#include "opencascade/BRepBuilderAPI_GTransform.hxx"
#include "opencascade/BRepBuilderAPI_MakeEdge.hxx"
#include "opencascade/BRepBuilderAPI_MakeFace.hxx"
#include "opencascade/BRepBuilderAPI_MakePolygon.hxx"
#include "opencascade/BRepBuilderAPI_MakeWire.hxx"
#include "opencascade/BRepBuilderAPI_Transform.hxx"
#include "opencascade/BRepOffsetAPI_MakePipe.hxx"
#include "opencascade/BRepOffsetAPI_ThruSections.hxx"
#include "opencascade/BRepPrimAPI_MakeCone.hxx"
#include "opencascade/BRepPrimAPI_MakeCylinder.hxx"
#include "opencascade/BRepPrimAPI_MakePrism.hxx"
#include "opencascade/BRepPrimAPI_MakeRevol.hxx"
#include "opencascade/BRepPrimAPI_MakeSphere.hxx"
#include "opencascade/BRepPrimAPI_MakeTorus.hxx"
#include "opencascade/GC_MakeArcOfCircle.hxx"
#include "opencascade/GeomAPI_PointsToBSpline.hxx"
#include "opencascade/GeomAPI_PointsToBSplineSurface.hxx"
#include "opencascade/Geom_BSplineCurve.hxx"
#include "opencascade/Geom_BSplineSurface.hxx"
#include "opencascade/Geom_TrimmedCurve.hxx"
#include "opencascade/TColgp_Array1OfPnt.hxx"
#include "opencascade/TColgp_Array2OfPnt.hxx"
#include "opencascade/TopoDS_Wire.hxx"
#include "opencascade/gp_Ax1.hxx"
#include "opencascade/gp_Ax2.hxx"
#include "opencascade/gp_Circ.hxx"
#include "opencascade/gp_Elips.hxx"
#include "opencascade/gp_GTrsf.hxx"
#include "opencascade/gp_Trsf.hxx"
#include "opencascade/gp_Vec.hxx"

namespace cusp::test {

namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;

gp_Ax2 random_place(Draw& draw, double low, double high)
{
    const double x = draw.uniform(5, 55);
    const double y = draw.uniform(5, 35);
    return {gp_Pnt(x, y, draw.uniform(low, high)), random_axis(draw)};
}

TopoDS_Wire circle(const gp_Ax2& at, double radius)
{
    return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(at, radius)));
}

TopoDS_Wire ellipse(const gp_Ax2& at, double longer, double shorter)
{
    return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Elips(at, longer, shorter)));
}

TopoDS_Shape extruded_spline(Draw& draw)
{
    const int corners = draw.whole(5, 9);
    const double x = draw.uniform(5, 55);
    const double y = draw.uniform(5, 35);
    const double radius = draw.uniform(5, 15);
    TColgp_Array1OfPnt points(1, corners + 1);
    for (int i = 0; i < corners; ++i) {
        const double angle = kTurn * i / corners;
        const double out = radius * draw.uniform(0.6, 1);
        points.SetValue(i + 1, {x + out * std::cos(angle), y + out * std::sin(angle), 0});
    }
    points.SetValue(corners + 1, points.Value(1));
    const GeomAPI_PointsToBSpline spline{points, 3, 8, GeomAbs_C1, 1e-3};
    const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(spline.Curve()));
    const double lean = draw.uniform(-5, 5);
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire),
                                 gp_Vec(lean, draw.uniform(-5, 5), draw.uniform(8, 25)));
}

TopoDS_Shape extruded_ellipse(Draw& draw)
{
    const gp_Ax2 at = random_place(draw, -2, 10);
    const double longer = draw.uniform(6, 14);
    const TopoDS_Wire wire = ellipse(at, longer, longer * draw.uniform(0.4, 1));
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire),
                                 gp_Vec(at.Direction()) * draw.uniform(5, 22));
}

TopoDS_Shape turned_polygon(Draw& draw)
{
    const double x = draw.uniform(10, 50);
    const double y = draw.uniform(10, 30);
    const double inner = draw.uniform(2, 6);
    const double outer = inner + draw.uniform(3, 8);
    BRepBuilderAPI_MakePolygon polygon;
    polygon.Add(gp_Pnt(x + inner, y, draw.uniform(-2, 2)));
    polygon.Add(gp_Pnt(x + outer, y, draw.uniform(-2, 2)));
    const double top = outer * draw.uniform(0.8, 1.1);
    polygon.Add(gp_Pnt(x + top, y, draw.uniform(6, 15)));
    polygon.Add(gp_Pnt(x + inner, y, draw.uniform(6, 12)));
    polygon.Close();
    const gp_Ax1 axis{gp_Pnt(x, y, 0), gp_Dir(draw.uniform(-0.1, 0.1), 0, 1)};
    return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon.Wire()), axis,
                                 draw.uniform(0.6, kTurn));
}

TopoDS_Shape part_of_a_turn(Draw& draw)
{
    const gp_Ax2 at = random_place(draw, 2, 15);
    const double a = draw.uniform(0, 1);
    const double b = draw.uniform(0, 1);
    const double c = draw.uniform(0, 1);
    const double turn = draw.uniform(1, 6);
    switch (draw.whole(0, 3)) {
        case 0:
            return BRepPrimAPI_MakeSphere(at, 5 + 7 * a, -1.2 * b, 0.3 + 1.1 * c, turn);
        case 1:
            return BRepPrimAPI_MakeTorus(at, 8 + 6 * a, 2 + 3 * b, 2 * c, 3 + 3 * c, turn);
        case 2:
            return BRepPrimAPI_MakeCone(at, 4 + 6 * a, 4 * b, 5 + 15 * c, turn);
        default:
            return BRepPrimAPI_MakeCylinder(at, 4 + 6 * a, 5 + 15 * c, turn);
    }
}

TopoDS_Shape pipe(Draw& draw)
{
    const double y = draw.uniform(5, 35);
    const gp_Pnt from{draw.uniform(5, 25), y, draw.uniform(5, 18)};
    const gp_Pnt to{draw.uniform(35, 55), 40 - y, draw.uniform(5, 18)};
    const gp_Pnt between{(from.X() + to.X()) / 2, 20 + draw.uniform(-6, 6), draw.uniform(8, 24)};
    const gp_Ax2 start{from, gp_Dir(gp_Vec(from, between))};
    const TopoDS_Wire spine = BRepBuilderAPI_MakeWire(
        BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(from, between, to).Value()));
    const TopoDS_Wire section = circle(start, draw.uniform(1.5, 4));
    return BRepOffsetAPI_MakePipe(spine, BRepBuilderAPI_MakeFace(section)).Shape();
}

TopoDS_Shape free_form(Draw& draw)
{
    TColgp_Array2OfPnt points(1, 6, 1, 5);
    const double x = draw.uniform(0, 30);
    const double y = draw.uniform(0, 15);
    const double width = draw.uniform(15, 30);
    const double depth = draw.uniform(12, 25);
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 5; ++j) {
            points.SetValue(i + 1, j + 1,
                            {x + width * i / 5, y + depth * j / 4, draw.uniform(12, 24)});
        }
    }
    const GeomAPI_PointsToBSplineSurface top{points, 3, 5, GeomAbs_C2, 1e-3};
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(top.Surface(), 1e-6),
                                 gp_Vec(0, 0, -draw.uniform(8, 12)));
}

TopoDS_Shape loft(Draw& draw)
{
    const double x = draw.uniform(10, 50);
    const double y = draw.uniform(10, 30);
    BRepOffsetAPI_ThruSections sections(true, draw.whole(0, 1) > 0);
    sections.AddWire(
        circle({gp_Pnt(x, y, draw.uniform(0, 4)), gp_Dir(0, 0, 1)}, 4 + draw.uniform(0, 6)));
    const double lean = draw.uniform(-0.2, 0.2);
    const gp_Pnt middle{x + draw.uniform(-4, 4), y + draw.uniform(-4, 4), draw.uniform(10, 14)};
    const double longer = draw.uniform(5, 9);
    sections.AddWire(ellipse({middle, gp_Dir(lean, draw.uniform(-0.2, 0.2), 1)}, longer,
                             longer * draw.uniform(0.4, 0.9)));
    if (draw.whole(0, 1) > 0) {
        sections.AddWire(
            circle({gp_Pnt(x, y, draw.uniform(18, 24)), gp_Dir(0, 0, 1)}, draw.uniform(2, 8)));
    }
    sections.Build();
    return sections.Shape();
}

}  // namespace

gp_Dir random_axis(Draw& draw)
{
    if (draw.whole(0, 2) == 0) {
        return {0, 0, 1};
    }
    const double x = draw.uniform(-1, 1);
    const double y = draw.uniform(-1, 1);
    return {x, y, draw.uniform(0.2, 1)};
}

TopoDS_Shape swept_body(Draw& draw)
{
    constexpr TopoDS_Shape (*kMakers[])(Draw&) = {
        extruded_spline, extruded_ellipse, turned_polygon, part_of_a_turn, pipe, free_form, loft};
    return kMakers[draw.whole(0, 6)](draw);
}

TopoDS_Shape stretched(Draw& draw, const TopoDS_Shape& shape)
{
    const int kind = draw.whole(0, 5);
    if (kind == 0) {
        gp_Trsf mirror;
        mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
        return BRepBuilderAPI_Transform(shape, mirror, true).Shape();
    }
    if (kind == 1) {
        gp_GTrsf stretch;
        for (int axis = 1; axis <= 3; ++axis) {
            stretch.SetValue(axis, axis, draw.uniform(0.6, 1.4));
        }
        return BRepBuilderAPI_GTransform(shape, stretch, true).Shape();
    }
    return shape;
}

}  // namespace cusp::test
