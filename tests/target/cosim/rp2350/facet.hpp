// Facet: one block of registers of a model that has several.
#pragma once

#include <functional>
#include <utility>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim::rp2350 {

class Facet final : public Model {
public:
    using Read = std::function<std::uint32_t(std::uint32_t offset)>;
    using Write = std::function<void(std::uint32_t offset, std::uint32_t value)>;
    Facet(Circuit& circuit, Read read, Write write, std::function<void()> reset)
        : Model{circuit}, read_{std::move(read)}, write_{std::move(write)}, reset_{std::move(reset)}
    {
    }

    std::uint32_t read(std::uint32_t offset) override { return read_(offset); }
    void write(std::uint32_t offset, std::uint32_t value) override { write_(offset, value); }
    void reset() override { reset_(); }

private:
    Read read_;
    Write write_;
    std::function<void()> reset_;
};

}  // namespace cusp::cosim::rp2350
