// Models of Open CASCADE, written as STEP and IGES.
#pragma once

#include <string>

#include "opencascade/IGESControl_Controller.hxx"
#include "opencascade/IGESControl_Writer.hxx"
#include "opencascade/Interface_Static.hxx"
#include "opencascade/STEPControl_Controller.hxx"
#include "opencascade/STEPControl_Writer.hxx"
#include "opencascade/TopoDS_Shape.hxx"

namespace cusp::test {

// Writes the shape, in mm, with lengths in `unit`, Open CASCADE's name. False: it can't.
inline bool write_step(const TopoDS_Shape& shape, const std::string& file, const char* unit = "MM")
{
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", unit);  // asked when the writer is made
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    return writer.Write(file.c_str()) == IFSelect_RetDone;
}

// As write_step().
//
// solids  as solids (the faces know their outside), or as loose faces
inline bool write_iges(const TopoDS_Shape& shape,
                       const std::string& file,
                       bool solids,
                       const char* unit = "MM")
{
    IGESControl_Controller::Init();
    IGESControl_Writer writer{unit, solids ? 1 : 0};
    writer.AddShape(shape);
    writer.ComputeModel();
    return writer.Write(file.c_str());
}

}  // namespace cusp::test
