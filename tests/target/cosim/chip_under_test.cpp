// The chip's wiring: which block lies where, what asks which stream, and how time passes.
#include "tests/target/cosim/chip_under_test.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kBlock = 0x400;
constexpr unsigned kDma1Clock = 21;
constexpr unsigned kDma2Clock = 22;
constexpr unsigned kPulseInterrupts[] = {57, 68};  // DMA2 streams 1 and 5

class PowerModel final : public Model {
public:
    PowerModel(Circuit& circuit, ClockModel& clocks) : Model{circuit}, clocks_{clocks} {}
    std::uint32_t read(std::uint32_t offset) override { return clocks_.read_power(offset); }
    void write(std::uint32_t offset, std::uint32_t value) override
    {
        clocks_.write_power(offset, value);
    }
    void reset() override {}

private:
    ClockModel& clocks_;
};

bool always() { return true; }

// A stream and a channel of DMA2 (RM0090 table 43).
struct Request {
    unsigned stream;
    unsigned channel;
};

std::vector<Request> requests_of_timer8(TimerModel::Event event)
{
    switch (event) {
        case TimerModel::Event::kUpdate:
            return {{1, 7}};
        case TimerModel::Event::kCompare1:
            return {{2, 7}, {2, 0}};
        case TimerModel::Event::kCompare2:
            return {{3, 7}, {2, 0}};
        case TimerModel::Event::kCompare3:
            return {{4, 7}, {2, 0}};
        case TimerModel::Event::kCompare4:
            return {{7, 7}};
    }
    return {};
}

std::vector<Request> requests_of_timer1(TimerModel::Event event)
{
    switch (event) {
        case TimerModel::Event::kUpdate:
            return {{5, 6}};
        case TimerModel::Event::kCompare1:
            return {{1, 6}, {3, 6}, {6, 0}};
        case TimerModel::Event::kCompare2:
            return {{2, 6}, {6, 0}};
        case TimerModel::Event::kCompare3:
            return {{6, 6}, {6, 0}};
        case TimerModel::Event::kCompare4:
            return {{4, 6}};
    }
    return {};
}

}  // namespace

ChipKind chip_kind(const std::string& name)
{
    // Data sheets DS8626, DS8626, DS10314, DS10693: rates, wait states at 3.3 V, memories. The F446
    // without its over-drive.
    if (name == "stm32f405" || name == "stm32f407") {
        return {{8000000, 168000000, 42000000, 84000000, 30000000, 1},
                1024 * 1024,
                128 * 1024,
                64 * 1024,
                true,
                "ABCDEFGHI"};
    }
    if (name == "stm32f446") {
        return {{8000000, 168000000, 45000000, 90000000, 30000000, 3},
                512 * 1024,
                128 * 1024,
                0,
                true,
                "ABCDEFGH"};
    }
    if (name == "stm32f411") {
        return {{25000000, 100000000, 50000000, 100000000, 30000000, 3},
                512 * 1024,
                128 * 1024,
                0,
                false,
                "ABCDEH"};
    }
    throw std::runtime_error{"no such chip: " + name};
}

ChipUnderTest::ChipUnderTest(const ChipKind& kind, const std::vector<std::uint8_t>& image)
    : kind_{kind}
{
    circuit_.memories.push_back(
        {0x20000000, std::vector<std::uint8_t>(kind.ram_bytes, 0xA5), true});
    if (kind.coupled_bytes != 0) {
        circuit_.memories.push_back(
            {0x10000000, std::vector<std::uint8_t>(kind.coupled_bytes, 0xA5), false});
    }
    clocks_ = std::make_unique<ClockModel>(circuit_, kind.clocks);
    flash_ = std::make_unique<FlashModel>(circuit_, *clocks_, kind.flash_bytes);
    if (image.size() > kind.flash_bytes) {
        throw std::runtime_error{"the image is larger than the flash"};
    }
    std::copy(image.begin(), image.end(), flash_->bytes().begin());
    make_blocks();
    make_timers();
    make_serial();
    core_ = std::make_unique<CoreModel>(
        circuit_, flash_->bytes(),
        CoreModel::Outside{
            [this](std::uint32_t address, unsigned size) { return read(address, size); },
            [this](std::uint32_t address, unsigned size, std::uint32_t value) {
                write(address, size, value);
            },
            [this](std::uint32_t address, unsigned size, std::uint32_t value) {
                store_flash(address, size, value);
            },
            [this] { happen_until_now(); },
            [this] {
                return circuit_.now >= end_ || circuit_.now < flash_->busy_until() ||
                       watchdog_->bitten() || !powered_ || exhausted();
            }});
    add(0xE000E000, "core", *core_, always);
    blocks_[0xE000E400] = blocks_[0xE000EC00] = blocks_[0xE000E000];
    reset(ClockModel::ResetCause::kPowerUp);
    resets_ = 0;
}

void ChipUnderTest::add(std::uint32_t address,
                        const std::string& name,
                        Model& model,
                        std::function<bool()> clocked)
{
    blocks_[address] = {&model, name, std::move(clocked)};
}

void ChipUnderTest::make_blocks()
{
    for (const char letter : kind_.ports) {
        const auto bit = static_cast<unsigned>(letter - 'A');
        ports_[letter] = std::make_unique<PortModel>(circuit_, letter);
        add(0x40020000 + bit * kBlock, std::string{"port "} + letter, *ports_[letter],
            [this, bit] { return clocks_->ahb1_on(bit); });
    }
    power_ = std::make_unique<PowerModel>(circuit_, *clocks_);
    watchdog_ = std::make_unique<WatchdogModel>(circuit_);
    const auto read_any = [this](std::uint32_t address) {
        return read(address, 4);
    };
    // DMA1 reaches its own bus only, where the ports are not.
    dma1_ = std::make_unique<DmaModel>(
        circuit_, "DMA1", std::array<unsigned, 8>{11, 12, 13, 14, 15, 16, 17, 47},
        DmaModel::Port{read_any, [this](std::uint32_t address, std::uint32_t value) {
                           if (address >= 0x40010000) {
                               circuit_.violate("DMA1: no way to " + hexadecimal(address));
                               return;
                           }
                           write(address, 4, value);
                       }});
    dma2_ = std::make_unique<DmaModel>(
        circuit_, "DMA2", std::array<unsigned, 8>{56, 57, 58, 59, 60, 68, 69, 70},
        DmaModel::Port{read_any, [this](std::uint32_t address, std::uint32_t value) {
                           write_by_dma(address, value);
                       }});
    add(0x40007000, "PWR", *power_, always);
    add(0x40023800, "RCC", *clocks_, always);
    add(0x40023C00, "FLASH", *flash_, always);
    add(0x40003000, "IWDG", *watchdog_, always);
    add(0x40026000, "DMA1", *dma1_, [this] { return clocks_->ahb1_on(kDma1Clock); });
    add(0x40026400, "DMA2", *dma2_, [this] { return clocks_->ahb1_on(kDma2Clock); });
    active_ = {dma1_.get(), dma2_.get(), watchdog_.get()};
}

void ChipUnderTest::add_timer(const std::string& name,
                              std::uint32_t address,
                              TimerModel::Wiring wiring,
                              std::function<bool()> clocked)
{
    auto timer = std::make_unique<TimerModel>(circuit_, name, std::move(wiring));
    add(address, name, *timer, std::move(clocked));
    active_.push_back(timer.get());
    timers_[name] = std::move(timer);
}

void ChipUnderTest::make_timers()
{
    const auto slow = [this] {
        return clocks_->slow_timer_hz();
    };
    const auto fast = [this] {
        return clocks_->fast_timer_hz();
    };
    const auto on_slow = [this](unsigned bit) {
        return [this, bit] {
            return clocks_->apb1_on(bit);
        };
    };
    const auto on_fast = [this](unsigned bit) {
        return [this, bit] {
            return clocks_->apb2_on(bit);
        };
    };
    const auto ask = [this](auto requests_of) {
        return [this, requests_of](TimerModel::Event event) {
            for (const Request& request : requests_of(event)) {
                static_cast<void>(dma2_->request(request.stream, request.channel));
            }
        };
    };
    add_timer("TIM2", 0x40000000, {slow, {}, {}, {}, 28, true}, on_slow(0));
    add_timer("TIM3", 0x40000400, {slow, {}, {}, {}, 29, false}, on_slow(1));
    add_timer("TIM4", 0x40000800, {slow, {}, {}, {}, 30, false}, on_slow(2));
    add_timer("TIM5", 0x40000C00, {slow, {}, {}, {}, 50, true}, on_slow(3));
    add_timer("TIM11", 0x40014800,
              {fast, {}, [this] { return clocks_->divided_crystal_hz(); }, {}, 26, false},
              on_fast(18));
    // RM0090 table 93: what ITR0 to ITR3 of a timer are.
    TimerModel* const gate = timers_["TIM2"].get();
    add_timer("TIM1", 0x40010000, {fast, ask(requests_of_timer1), {}, {nullptr, gate}, -1, false},
              on_fast(0));
    gate->set_listener(timers_["TIM1"].get());
    if (kind_.has_timer8) {
        add_timer("TIM8", 0x40010400,
                  {fast, ask(requests_of_timer8), {}, {nullptr, gate}, -1, false}, on_fast(1));
        gate->set_listener(timers_["TIM8"].get());
    }
}

// RM0090 tables 42 and 43: the streams that take and give bytes, all by channel 4.
struct ChipUnderTest::SerialWiring {
    unsigned number;
    std::uint32_t address;
    DmaModel& dma;
    std::vector<unsigned> receive_streams;
    std::vector<unsigned> send_streams;
    std::function<std::uint32_t()> bus_hz;
    std::function<bool()> clocked;
    unsigned first_pin;  // of port A: transmit, then receive
    unsigned interrupt;
};

void ChipUnderTest::add_serial(const SerialWiring& wiring)
{
    DmaModel* const dma = &wiring.dma;
    const auto ask = [dma](const std::vector<unsigned>& streams) {
        return [dma, streams] {
            return std::any_of(streams.begin(), streams.end(),
                               [dma](unsigned stream) { return dma->request(stream, 4); });
        };
    };
    const std::string name = "USART" + std::to_string(wiring.number);
    auto& usart = usarts_.at(wiring.number - 1);
    usart = std::make_unique<UsartModel>(
        circuit_, name,
        UsartModel::Wiring{wiring.bus_hz, ask(wiring.receive_streams), ask(wiring.send_streams),
                           [this, first = wiring.first_pin] {
                               const PortModel& a = *ports_.at('A');
                               return a.mode(first) == 2 && a.function(first) == 7 &&
                                      a.mode(first + 1) == 2 && a.function(first + 1) == 7;
                           },
                           wiring.interrupt});
    dma->set_start_listener([port = usart.get()] { port->stream_ready(); });
    add(wiring.address, name, *usart, wiring.clocked);
    active_.push_back(usart.get());
}

void ChipUnderTest::make_serial()
{
    add_serial({1,
                0x40011000,
                *dma2_,
                {2, 5},
                {7},
                [this] { return clocks_->fast_bus_hz(); },
                [this] { return clocks_->apb2_on(4); },
                9,
                37});
    add_serial({2,
                0x40004400,
                *dma1_,
                {5},
                {6},
                [this] { return clocks_->slow_bus_hz(); },
                [this] { return clocks_->apb1_on(17); },
                2,
                38});
}

PortModel& ChipUnderTest::port(char letter)
{
    const auto found = ports_.find(letter);
    if (found == ports_.end()) {
        throw std::runtime_error{std::string{"the chip has no port "} + letter};
    }
    return *found->second;
}

auto ChipUnderTest::block_of(std::uint32_t address, unsigned size, const char* what) -> Block*
{
    const auto found = blocks_.find(address & ~(kBlock - 1));
    if (found == blocks_.end()) {
        circuit_.violate(std::string{what} + " where no register is, " + hexadecimal(address));
        return nullptr;
    }
    if (size != 4) {
        circuit_.violate(found->second.name + ": " + what + " of " + std::to_string(size) +
                         " bytes");
    }
    if (!found->second.clocked()) {
        circuit_.violate(found->second.name + ": " + what + " without its clock, " +
                         hexadecimal(address));
        return nullptr;
    }
    return &found->second;
}

std::uint32_t ChipUnderTest::read(std::uint32_t address, unsigned size)
{
    constexpr std::uint32_t kDebug = 0xE0042000;
    if (address >= kDebug && address < kDebug + 0x10) {
        return address == kDebug + 8 ? freeze_1_ : address == kDebug + 12 ? freeze_2_ : 0;
    }
    Block* const block = block_of(address, size, "read");
    const bool core = address >= 0xE0000000;
    return block == nullptr ? 0 : block->model->read(address & (core ? 0xFFFU : kBlock - 1));
}

void ChipUnderTest::write(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (address == 0xE0042008 || address == 0xE004200C) {
        (address == 0xE0042008 ? freeze_1_ : freeze_2_) = value;
        return;
    }
    Block* const block = block_of(address, size, "write");
    if (block == nullptr) {
        return;
    }
    const bool core = address >= 0xE0000000;
    block->model->write(address & (core ? 0xFFFU : kBlock - 1), value);
    if (clocks_->changes() != clock_changes_) {
        clock_changes_ = clocks_->changes();
        for (const auto& timer : timers_) {
            timer.second->look_again();
        }
    }
}

void ChipUnderTest::write_by_dma(std::uint32_t address, std::uint32_t value)
{
    const char letter = static_cast<char>('A' + (address - 0x40020000) / kBlock);
    if (address >= 0x40020000 && ports_.count(letter) != 0) {
        if (!clocks_->ahb1_on(static_cast<unsigned>(letter - 'A'))) {
            circuit_.violate(std::string{"port "} + letter + ": DMA writes without its clock");
            return;
        }
        ports_[letter]->write_by_dma(address & (kBlock - 1), value);
        return;
    }
    write(address, 4, value);
}

void ChipUnderTest::store_flash(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (writes_left_ == 0) {
        // Amid the write: some of its bits are cleared. The engine still stores the word.
        powered_ = false;
        torn_place_ = address - 0x08000000;
        std::memcpy(&torn_word_, &flash_->bytes()[torn_place_], 4);
        torn_word_ &= value | 0x0F0F3355U;
        return;
    }
    writes_left_ -= writes_left_ > 0 ? 1 : 0;
    flash_->store(address, size, value);
}

void ChipUnderTest::find_next()
{
    Picoseconds first = kNever;
    for (const Model* const model : active_) {
        first = std::min(first, model->due());
    }
    circuit_.next_event = first;
}

// Each event happens at its own time; the core is a block ahead of them at most.
void ChipUnderTest::happen_until_now()
{
    const Picoseconds now = circuit_.now;
    for (;;) {
        Model* first = nullptr;
        Picoseconds due = kNever;
        for (Model* const model : active_) {
            if (model->due() < due) {
                due = model->due();
                first = model;
            }
        }
        if (first == nullptr || due > now) {
            circuit_.next_event = due;
            break;
        }
        circuit_.now = due;
        first->happen();
        listen_for_ticks();
    }
    circuit_.now = now;
}

void ChipUnderTest::listen_for_ticks()
{
    const bool line = circuit_.interrupt_lines[kPulseInterrupts[kind_.has_timer8 ? 0 : 1]];
    if (line && !pace_line_ && tick_listener_) {
        tick_listener_();
    }
    pace_line_ = line;
}

void ChipUnderTest::advance(Picoseconds to)
{
    while (circuit_.now < to) {
        find_next();
        circuit_.now = std::max(circuit_.now, std::min(to, circuit_.next_event));
        happen_until_now();
        if (circuit_.interrupts_changed || watchdog_->bitten()) {
            return;
        }
    }
}

void ChipUnderTest::run(Picoseconds time, const std::function<bool()>& until)
{
    end_ = circuit_.now + time;
    while (circuit_.now < end_ && powered_ && !exhausted()) {
        if (watchdog_->bitten()) {
            reset(ClockModel::ResetCause::kWatchdog);
        } else if (core_->reset_wanted()) {
            reset(ClockModel::ResetCause::kSoftware);
        }
        const bool stalled = circuit_.now < flash_->busy_until();
        if (held_ || core_->locked_up() || stalled) {
            circuit_.interrupts_changed = false;
            advance(stalled && !held_ ? std::min(end_, flash_->busy_until()) : end_);
            circuit_.interrupts_changed = true;
            continue;
        }
        if (circuit_.interrupts_changed) {
            core_->take_exception();
        }
        if (!core_->sleeping()) {
            core_->run();
            continue;
        }
        if (until && until()) {
            return;
        }
        if (!circuit_.interrupts_changed) {
            advance(end_);
        }
    }
}

void ChipUnderTest::reset(ClockModel::ResetCause cause)
{
    ++resets_;
    clocks_->note_reset(cause);
    clocks_->reset();
    flash_->reset();
    watchdog_->reset();
    dma1_->reset();
    dma2_->reset();
    for (const auto& usart : usarts_) {
        usart->reset();
    }
    for (const auto& timer : timers_) {
        timer.second->reset();
    }
    for (const auto& port : ports_) {
        port.second->reset();
    }
    circuit_.interrupt_lines = {};
    core_->reset();
}

void ChipUnderTest::stop_core(bool debugger)
{
    held_ = true;
    if (debugger) {
        timers_["TIM1"]->freeze((freeze_2_ & 1U) != 0);
        if (kind_.has_timer8) {
            timers_["TIM8"]->freeze((freeze_2_ & 2U) != 0);
        }
        timers_["TIM2"]->freeze((freeze_1_ & 1U) != 0);
        watchdog_->freeze((freeze_1_ >> 12U & 1U) != 0);
    }
}

void ChipUnderTest::go_on()
{
    held_ = false;
    for (const auto& timer : timers_) {
        timer.second->freeze(false);
    }
    watchdog_->freeze(false);
}

void ChipUnderTest::power_cycle()
{
    for (MemoryArea& area : circuit_.memories) {
        std::fill(area.bytes.begin(), area.bytes.end(), std::uint8_t{0x5A});
    }
    if (!powered_) {
        std::memcpy(&flash_->bytes()[torn_place_], &torn_word_, 4);
    }
    powered_ = true;
    writes_left_ = -1;
    freeze_1_ = freeze_2_ = 0;
    held_ = false;
    for (const auto& usart : usarts_) {
        usart->unplug();
    }
    reset(ClockModel::ResetCause::kPowerUp);
}

}  // namespace cusp::cosim
