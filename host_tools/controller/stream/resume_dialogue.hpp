// ResumeDialogue: where an interrupted transfer goes on, the way there in words, and the user's consent.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "host_tools/controller/stream/approach.hpp"
#include "host_tools/controller/stream/resume_point.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"

namespace cusp::stream {

class ResumeDialogue {
public:
    // Is shown the way; `lost`: the controller has probably lost the tool's position. True: go on.
    using Consent = std::function<bool(const std::string& way, bool lost)>;

    // program  file that was sent
    // line     of the file, that the tool had reached; 0: that of the record beside the program
    // safe_z   as for make_approach()
    //
    // Throws InputError where there is no record and no line is given.
    ResumeDialogue(std::string program,
                   std::uint64_t line,
                   std::optional<double> safe_z,
                   Consent consent);

    // For StreamOptions; the dialogue outlives the transfer.
    StreamResume resume() const;

private:
    Approach approach(const ControllerFacts& facts, Position machine) const;
    std::string text_of(const Approach& way, bool homes, bool lost) const;

    std::string program_;
    std::optional<double> safe_z_;
    Consent consent_;
    TransferRecord record_;
    ResumePoint point_;
};

}  // namespace cusp::stream
