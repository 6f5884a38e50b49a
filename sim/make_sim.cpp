#include "sim/make_sim.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/sim_host.h"
#include "transport/loopback.h"

namespace xorvox::sim {

double slices_off(const DisplayDescription& display, std::uint32_t slice, double cycles) {
    const double slices = keeps_light(display) ? 1.0 : display.slices;
    const auto off = [&](double begin, double part, double nth) {
        const double length = part / slices;
        const double middle = begin + (nth + 0.5) * length;
        const double away = std::remainder(cycles - middle, 1.0) / length;
        return std::copysign(std::max(std::abs(away) - 0.5, 0.0), away);
    };
    const double nth = keeps_light(display) ? 0.0 : slice;
    if (display.kind != DisplayKind::SweptPlane) return off(0.0, 1.0, nth);
    const double dead = display.motion.dead_zone / 2.0;
    const double part = 0.5 - 2.0 * dead;
    const double up = off(dead, part, nth);
    if (!display.motion.both_ways) return up;
    const double down = off(0.5 + dead, part, slices - 1.0 - nth);
    return std::abs(up) < std::abs(down) ? up : down;
}

struct SimRig::Impl {
    std::pair<UniqueLink, UniqueLink> ends;
    std::optional<Simulator> simulator;
    std::function<void(std::uint64_t)> host;
    std::optional<SimHost> own_host;
    StrobeSink sink;
    std::vector<SeenStrobe> strobes;
    std::uint64_t now_ns = 0;

    void see(const Strobe& strobe) {
        SeenStrobe seen{.on_ns = strobe.on_ns,
                        .off_ns = strobe.off_ns,
                        .frame = strobe.frame,
                        .slice = strobe.slice,
                        .row_group = strobe.row_group,
                        .plane = strobe.plane};
        seen.cycles = simulator->cycles_at(strobe.on_ns + (strobe.off_ns - strobe.on_ns) / 2);
        seen.slices_off = slices_off(simulator->display(), seen.slice, seen.cycles);
        strobes.push_back(seen);
        if (sink) sink(strobe);
    }

    void move() {
        do {
            if (host) host(now_ns);
            if (own_host) own_host->poll(now_ns);
        } while (simulator->poll(now_ns) == Status::Ok);
    }
};

SimRig::SimRig(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SimRig::SimRig(SimRig&&) noexcept = default;
SimRig& SimRig::operator=(SimRig&&) noexcept = default;
SimRig::~SimRig() = default;

const DisplayDescription& SimRig::display() const {
    return impl_->simulator->display();
}
Simulator& SimRig::simulator() {
    return *impl_->simulator;
}
const Simulator& SimRig::simulator() const {
    return *impl_->simulator;
}
Link SimRig::host_end() {
    return impl_->ends.first.get();
}
void SimRig::set_host(std::function<void(std::uint64_t)> host) {
    impl_->host = std::move(host);
}

std::uint32_t SimRig::show(std::span<const std::byte> page, std::uint64_t present_at_ns) {
    if (page.size() != frame_bytes(display())) return 0;
    if (!impl_->own_host) impl_->own_host.emplace(host_end(), impl_->now_ns);
    const std::uint32_t frame = impl_->own_host->send_frame(page, present_at_ns);
    impl_->move();
    return frame;
}

std::uint64_t SimRig::now_ns() const {
    return impl_->now_ns;
}

void SimRig::run_for(std::uint64_t ns) {
    (void)run_until([] { return false; }, ns);
}

bool SimRig::run_until(const std::function<bool()>& done, std::uint64_t at_most_ns) {
    const std::uint64_t end_ns = impl_->now_ns + at_most_ns;
    for (;;) {
        impl_->move();
        if (done()) return true;
        if (impl_->now_ns == end_ns) return false;
        impl_->now_ns = std::min(impl_->now_ns + kStep_ns, end_ns);
    }
}

const std::vector<SeenStrobe>& SimRig::strobes() const {
    return impl_->strobes;
}
void SimRig::forget() {
    impl_->strobes.clear();
}
void SimRig::watch(StrobeSink sink) {
    impl_->sink = std::move(sink);
}

MakeSim& MakeSim::display(const DisplayDescription& display) {
    display_ = display;
    return *this;
}

namespace {

void make_moving(DisplayDescription& display, DisplayKind kind, std::uint32_t slices) {
    display.kind = kind;
    display.slices = slices;
    display.cycles_per_second = display.cycles_per_second > 0.0 ? display.cycles_per_second : 20.0;
    if (display.sync.index == IndexSource::None) display.sync.index = IndexSource::Pulses;
}

}  // namespace

MakeSim& MakeSim::rotating(std::uint32_t slices) {
    make_moving(display_, DisplayKind::RotatingPanel, slices);
    return *this;
}
MakeSim& MakeSim::stacked(std::uint32_t planes) {
    display_.kind = DisplayKind::StackedPlanes;
    display_.slices = planes;
    return *this;
}
MakeSim& MakeSim::swept(std::uint32_t slices, MotionProfile profile) {
    make_moving(display_, DisplayKind::SweptPlane, slices);
    display_.motion.profile = profile;
    return *this;
}
MakeSim& MakeSim::helix(std::uint32_t slices, std::uint32_t blades) {
    make_moving(display_, DisplayKind::Helix, slices);
    display_.blades = blades;
    return *this;
}
MakeSim& MakeSim::panel(std::uint16_t columns, std::uint16_t rows, double pitch_mm) {
    const std::uint32_t number = panels_.value_or(0);
    panels_ = number + 1;
    if (number == 0) pitch_mm_ = pitch_mm;
    if (number < kMaxPanels) {
        display_.panels[number] = {
            .columns = columns, .rows = rows, .column_pitch_mm = pitch_mm, .row_pitch_mm = pitch_mm};
        display_.panels[number].chain_position = static_cast<std::uint8_t>(number);
    }
    return *this;
}
MakeSim& MakeSim::format(PixelFormat format) {
    display_.format = format;
    return *this;
}
MakeSim& MakeSim::cycles_per_second(double cycles) {
    display_.cycles_per_second = cycles;
    return *this;
}
MakeSim& MakeSim::scan(const Scan& scan) {
    display_.scan = scan;
    return *this;
}
MakeSim& MakeSim::index_pulses(std::uint32_t pulses_per_turn) {
    display_.sync.index = IndexSource::Pulses;
    display_.sync.index_pulses = pulses_per_turn;
    return *this;
}
MakeSim& MakeSim::encoder(std::uint32_t steps_per_turn) {
    display_.sync.index = IndexSource::Encoder;
    display_.sync.index_pulses = steps_per_turn;
    return *this;
}
MakeSim& MakeSim::index_phase(double cycles) {
    display_.sync.index_phase = cycles;
    return *this;
}
MakeSim& MakeSim::change(std::function<void(DisplayDescription&)> change) {
    change_ = std::move(change);
    return *this;
}

MakeSim& MakeSim::rotor(const RotorConditions& conditions) {
    rotor_ = conditions;
    seed_ = conditions.seed;
    return *this;
}
MakeSim& MakeSim::speed(double times) {
    conditions().speed = times;
    return *this;
}
MakeSim& MakeSim::spin_up(double seconds) {
    conditions().spin_up_s = seconds;
    return *this;
}
MakeSim& MakeSim::acceleration(double part_per_second) {
    conditions().acceleration = part_per_second;
    return *this;
}
MakeSim& MakeSim::jitter(double part) {
    conditions().jitter = part;
    return *this;
}
MakeSim& MakeSim::missed(double probability) {
    conditions().missed = probability;
    return *this;
}
MakeSim& MakeSim::doubled(double probability) {
    conditions().doubled = probability;
    return *this;
}
MakeSim& MakeSim::noise(double part_of_turn) {
    conditions().noise = part_of_turn;
    return *this;
}
MakeSim& MakeSim::stall_at(double seconds) {
    conditions().stall_s = seconds;
    return *this;
}
MakeSim& MakeSim::seed(std::uint64_t seed) {
    seed_ = seed;
    return *this;
}
MakeSim& MakeSim::fault(const Fault& fault) {
    options_.faults.list.push_back(fault);
    return *this;
}
MakeSim& MakeSim::fidelity(Fidelity fidelity) {
    options_.fidelity = fidelity;
    return *this;
}
MakeSim& MakeSim::built_like(const DisplayDescription& built) {
    options_.built = built;
    return *this;
}

RotorConditions& MakeSim::conditions() {
    return rotor_ ? *rotor_ : rotor_.emplace();
}

namespace {

/// Evenly, and so far from it that they do not touch.
void stand_about_axis(DisplayDescription& display) {
    const std::span panels = std::span(display.panels).first(std::min<std::size_t>(display.panel_count, kMaxPanels));
    double width_mm = 0.0;
    for (const Panel& panel : panels) width_mm = std::max(width_mm, panel.columns * panel.column_pitch_mm);
    // 1 / tan(π/n) < n/3.
    const double sides = static_cast<double>(panels.size());
    const double offset_mm = panels[0].column_pitch_mm + (sides > 2.0 ? width_mm / 2.0 * sides / 3.0 : 0.0);
    for (std::size_t p = 0; p < panels.size(); ++p) {
        panels[p].angle_deg = 360.0 * static_cast<double>(p) / sides;
        panels[p].offset_mm = offset_mm;
    }
}

}  // namespace

DisplayDescription MakeSim::description() const {
    DisplayDescription made = display_;
    if (made.name.view().empty()) made.name = DisplayName("simulated");
    if (made.cycles_per_second == 0.0) made.cycles_per_second = 100.0;
    if (panels_) made.panel_count = *panels_;
    if (made.kind == DisplayKind::RotatingPanel && panels_.value_or(1) > 1) stand_about_axis(made);
    const bool is_stack = made.kind == DisplayKind::StackedPlanes && made.plane_heights_mm.empty();
    if (panels_ && is_stack) made.plane_pitch_mm = pitch_mm_;
    const bool has_stroke = made.kind == DisplayKind::SweptPlane || made.kind == DisplayKind::Helix;
    if (has_stroke && made.motion.stroke_mm == 0.0) made.motion.stroke_mm = pitch_mm_ * made.slices;
    if (change_) change_(made);
    return made;
}

Expected<SimRig> MakeSim::build() const {
    const DisplayDescription display = description();
    SimulatorOptions options = options_;
    options.rotor = rotor_;
    if (options.rotor) options.rotor->seed = seed_;
    options.faults.seed = seed_;
    options.keeps_time = true;
    auto impl = std::make_unique<SimRig::Impl>();
    impl->ends = transport::make_loopback();
    Expected<Simulator> simulator = Simulator::make(display, impl->ends.second.get(), options);
    if (!simulator) return tl::unexpected(simulator.error());
    impl->simulator.emplace(std::move(*simulator));
    impl->simulator->watch([rig = impl.get()](const Strobe& strobe) { rig->see(strobe); });
    impl->move();
    return SimRig(std::move(impl));
}

}  // namespace xorvox::sim
