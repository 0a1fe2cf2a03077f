// A folder for the files of one test, gone at its end.
#pragma once

#include <string>

#include "host_tools/input_error/input_error.hpp"

class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    // Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const;
    std::string path(const std::string& name) const { return folder_ + "/" + name; }

private:
    std::string folder_;
};

// The text of the InputError that `act` throws; "" where it throws none.
template <class Act>
std::string refusal(Act act)
{
    try {
        act();
    } catch (const cusp::host::InputError& error) {
        return error.what();
    }
    return "";
}
