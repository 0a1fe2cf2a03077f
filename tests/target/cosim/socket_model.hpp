// SocketModel: a drive in its socket, of whatever kind: its faults, and what it holds.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class SocketModel : public Model {
public:
    using Model::Model;

    // Faults: no module, or none with power; a wrong bit in so many answers; another chip; writes that are lost;
    // bits of DRV_STATUS.
    virtual void set_missing(bool on) = 0;
    virtual void garble_answers(unsigned count) = 0;
    virtual void set_version(std::uint32_t version) = 0;
    virtual void set_deaf(bool on) = 0;
    virtual void set_status(std::uint32_t bits) = 0;
    // By how much its bits are longer than those of the request.
    virtual void set_drift(std::int32_t /*parts_per_thousand*/)
    {
        throw std::runtime_error{"a drive without a clock of its own"};
    }
    // Its supply sinks and comes back.
    virtual void starve() { throw std::runtime_error{"a drive that does not keep that in mind"}; }

    virtual const std::map<std::uint32_t, std::uint32_t>& registers() const = 0;
    virtual std::uint64_t answers() const = 0;
    virtual std::uint64_t damaged() const = 0;  // requests that it could not take
    virtual Picoseconds written_at() const = 0;
    // The rate of the last datagram, bits a second.
    virtual double baud() const = 0;
};

}  // namespace cusp::cosim
