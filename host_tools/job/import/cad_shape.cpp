// Reads STEP and IGES with the fewest repairs, and rejects files that crash Open CASCADE.
#include "host_tools/job/import/cad_shape.hpp"

#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"
#include "opencascade/BRepTools.hxx"
#include "opencascade/BRep_Builder.hxx"
#include "opencascade/IGESControl_Reader.hxx"
#include "opencascade/IGESData_GlobalSection.hxx"
#include "opencascade/IGESData_IGESModel.hxx"
#include "opencascade/Interface_Check.hxx"
#include "opencascade/Interface_CheckIterator.hxx"
#include "opencascade/Message.hxx"
#include "opencascade/Message_Messenger.hxx"
#include "opencascade/STEPControl_Reader.hxx"
#include "opencascade/ShapeFix_Face.hxx"
#include "opencascade/ShapeFix_Shape.hxx"
#include "opencascade/ShapeFix_Solid.hxx"
#include "opencascade/ShapeFix_Wire.hxx"
#include "opencascade/TColStd_SequenceOfAsciiString.hxx"
#include "opencascade/TCollection_HAsciiString.hxx"
#include "opencascade/XSAlgo.hxx"
#include "opencascade/XSAlgo_AlgoContainer.hxx"
#include "opencascade/XSControl_WorkSession.hxx"

namespace cusp::import {
namespace {

// Open CASCADE's default repairs without the orientation of wires: where a seam ends in a pole on
// the edge of a face, that repair cuts the seam off and keeps the wrong part of a ball.
class GentleRepairs : public XSAlgo_AlgoContainer {
public:
    TopoDS_Shape ProcessShape(const TopoDS_Shape& shape,
                              double precision,
                              double max_tolerance,
                              const char* resource,
                              const char* sequence,
                              Handle(Standard_Transient) & about,
                              const Message_ProgressRange& progress,
                              bool non_manifold) const override
    {
        if (shape.IsNull()) {
            return XSAlgo_AlgoContainer::ProcessShape(shape, precision, max_tolerance, resource,
                                                      sequence, about, progress, non_manifold);
        }
        ShapeFix_Shape repair{shape};
        repair.SetPrecision(precision);
        repair.SetMaxTolerance(max_tolerance);
        repair.FixFaceTool()->FixOrientationMode() = 0;
        repair.FixFaceTool()->FixWireTool()->FixSameParameterMode() = 0;
        repair.FixSolidTool()->CreateOpenSolidMode() = false;
        repair.Perform(progress);
        return repair.Shape();
    }
};

// True if the reading ends, and without a crash: a child process tries it.
//
// seconds  of CPU time at most
template <class Reading>
bool survives(rlim_t seconds, const Reading& read)
{
    const pid_t child = fork();
    if (child == 0) {
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        const rlimit time{seconds, seconds};
        setrlimit(RLIMIT_CPU, &time);
        try {
            read();
        } catch (...) {
        }
        _exit(0);
    }
    int status = 0;
    return child < 0 || (waitpid(child, &status, 0) == child && status == 0);
}

// Open CASCADE dereferences entities that it failed to read. Most files with faults are read
// correctly, so only those that crash it are rejected.
void check_faults(const std::string& file, XSControl_Reader& reader)
{
    Interface_CheckIterator faults = reader.WS()->ModelCheckList(true).Extract(Interface_CheckFail);
    faults.Start();
    if (faults.More() && !survives(RLIM_INFINITY, [&] { reader.TransferRoots(); })) {
        throw InputError(
            fmt::format("{}: Open CASCADE can't make a shape of it; the first fault: "
                        "entity {}: {}",
                        file, faults.Number(), faults.Value()->CFail(1)));
    }
}

// The unit of length as the file names it.
std::string unit_of(XSControl_Reader& reader, bool step)
{
    if (step) {
        TColStd_SequenceOfAsciiString lengths;
        TColStd_SequenceOfAsciiString angles;
        TColStd_SequenceOfAsciiString solid_angles;
        static_cast<STEPControl_Reader&>(reader).FileUnits(lengths, angles, solid_angles);
        return lengths.IsEmpty() ? "" : lengths.First().ToCString();
    }
    const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
    const Handle(TCollection_HAsciiString) name =
        model.IsNull() ? nullptr : model->GlobalSection().UnitName();
    return name.IsNull() ? "" : name->ToCString();
}

// Open CASCADE's own format; nothing is repaired.
TopoDS_Shape brep_shape(const std::string& file)
{
    constexpr rlim_t kSeconds = 5;
    constexpr rlim_t kBytesPerSecond = 1000000;  // a tenth of what it reads
    const std::string text = files::text_of_file(file);
    // The last line is the sense, number and place of the whole shape: "+1 0".
    const std::size_t end = text.find_last_not_of(" \r\n");
    const std::size_t last = end == std::string::npos ? end : text.rfind('\n', end);
    if (last == std::string::npos || (text[last + 1] != '+' && text[last + 1] != '-')) {
        throw InputError(file + ": this is no BREP file, or it is cut short");
    }
    TopoDS_Shape shape;
    const auto read = [&] {
        return BRepTools::Read(shape, file.c_str(), BRep_Builder{});
    };
    if (!survives(kSeconds + text.size() / kBytesPerSecond, read) || !read() || shape.IsNull()) {
        throw InputError(file + ": this is no BREP file");
    }
    return shape;
}

}  // namespace

ReadShape read_shape(const std::string& file, Repairs repairs)
{
    Message::DefaultMessenger()->ChangePrinters().Clear();
    files::text_of_file(file);  // throws with the reason where the file can't be read
    const std::string ending = path_ending(file);
    if (ending == ".brep" || ending == ".brp") {
        return {brep_shape(file), ""};
    }
    const bool step = ending == ".step" || ending == ".stp";
    std::unique_ptr<XSControl_Reader> reader;
    if (step) {
        reader = std::make_unique<STEPControl_Reader>();
    } else {
        reader = std::make_unique<IGESControl_Reader>();
    }
    if (reader->ReadFile(file.c_str()) != IFSelect_RetDone) {
        throw InputError(fmt::format("{}: this is no {} file", file, step ? "STEP" : "IGES"));
    }
    if (repairs == Repairs::kGentle) {
        XSAlgo::SetAlgoContainer(new GentleRepairs);
    } else {
        XSAlgo::SetAlgoContainer(new XSAlgo_AlgoContainer);
    }
    check_faults(file, *reader);
    reader->TransferRoots();
    const TopoDS_Shape shape = reader->OneShape();
    if (shape.IsNull()) {
        throw InputError(file + ": the file holds no shape");
    }
    return {shape, unit_of(*reader, step)};
}

}  // namespace cusp::import
