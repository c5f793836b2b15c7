// eigengrain waves transmit: a wave sent through a packing by the solver of the runs, and what is read from it.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "app/waves_commands.hpp"
#include "app/waves_transmit_report.hpp"
#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "state/gather.hpp"
#include "timestep/interval.hpp"
#include "waves/unit_cell.hpp"

namespace eg {
namespace {

struct TransmitFlags {
  PackingFlags packing;
  std::string axis, motion, signal = "sine", figure, traces, tables;
  std::vector<double> point;
  double frequency = 0, last = 0, amplitude = 1e-3, duration = 0, step = 0.2, damping = 0;
};

/// 0, 1, 2 of "x", "y", "z"; the last axis of the packing when nothing is said.
int axis_of(const std::string& name, int usual, int dimension, const char* flag) {
  if (name.empty()) return usual;
  const int axis = name[0] - 'x';
  if (axis >= dimension) throw InputError(fmt::format("{}: a packing in two dimensions has no z; take x or y", flag));
  return axis;
}

Signal signal_of(const TransmitFlags& f) {
  if (f.signal == "sweep" && !(f.last > f.frequency))
    throw InputError("--to: a sweep needs a last frequency above the first");
  const auto kind = f.signal == "ricker"  ? Signal::Kind::ricker
                    : f.signal == "sweep" ? Signal::Kind::sweep
                                          : Signal::Kind::sine;
  return {kind, f.frequency, f.last};
}

double mean_overlap(const Scene& scene, const State& state) {
  double sum = 0;
  std::size_t count = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) { sum += p.geometry.overlap, ++count; });
  if (count == 0) throw RunError("nothing touches: no wave travels; compress the packing first");
  return sum / static_cast<double>(count);
}

/// Speed that the affine stiffness gives, an upper bound: to plan the test with where there is no dispersion.
double affine_speed(const Network& net, double volume, int axis, int motion) {
  double stiffness = 0, mass = 0;
  for (const auto& s : net.springs) {
    if (s.j == no_index || s.couple) continue;
    const double a = s.n[axis] * s.n[axis], m = s.n[motion] * s.n[motion];
    stiffness += s.length * s.length *
                 ((s.normal - s.tangential) * a * m + s.tangential * (axis == motion ? a : (a + m) / 4)) / volume;
  }
  for (const double inverse : net.inverse_mass) mass += inverse > 0 ? 1 / inverse / volume : 0;
  return std::sqrt(stiffness / mass);
}

constexpr std::size_t most_rows = 60;  // of a unit cell whose branch is worth drawing

/// The branch of the unit cell, for packings that have a small one.
std::optional<Branch> branch_of(const Snapshot& work, const Network& net, int axis, int motion, double spacing) {
  for (int k = 0; k < work.scene.dimension; ++k)
    if (!work.state.cell.periodic[static_cast<std::size_t>(k)]) return {};
  std::vector<Vec3> position;
  for (const auto& q : work.state.grains.position) position.push_back(q.vec());
  const UnitCell unit = find_unit_cell(net, position, work.state.cell.h);
  if (total_dofs(unit.network) > most_rows) return {};
  return acoustic_branch(unit.network, axis, motion, std::numbers::pi / spacing);
}

/// Nearest trace that is no closer than `distance`; the last one if all are.
std::size_t trace_at(const Transmission& test, double distance) {
  for (std::size_t k = 0; k < test.traces.size(); ++k)
    if (test.traces[k].distance >= distance * (1 - 1e-9)) return k;
  return test.traces.size() - 1;
}

void read_traces(TransmitReport& r) {
  const double wave = r.wavelength, last = r.test.traces.back().distance;
  r.near = trace_at(r.test, std::min(wave, 0.15 * last));
  r.far = trace_at(r.test, std::min(r.test.traces[r.near].distance + 5 * wave, 0.9 * last));
  r.arrivals = arrivals(r.test, r.near, r.far, r.setup.signal.frequency);
  r.from_source = arrivals(r.test, 0, r.far, r.setup.signal.frequency);
  r.phase_speed = phase_speed(r.test, r.near, r.far, r.setup.signal.frequency);
  const double top = r.branch ? 1.3 * r.branch->highest() : 4 * r.setup.signal.frequency;
  for (int k = 1; k <= 400; ++k) r.frequencies.push_back(top * k / 400);
  r.response = response(r.test, 2, std::min<std::size_t>(r.test.traces.size() / 3, 14), r.frequencies);
  r.cutoff = cutoff(r.frequencies, r.response);
  if (r.test.spacing == 0) return;
  std::vector<std::span<const double>> all;
  for (const auto& trace : r.test.traces) all.emplace_back(trace.u);
  r.map = wave_map(all, r.test.interval, r.test.spacing, top);
  r.ridge = ridge(*r.map);
}

void warn(TransmitReport& r, double length) {
  const double travel = r.test.traces[r.far].distance - r.test.traces[r.near].distance;
  const auto say = [&](std::string text) { r.warnings.push_back(std::move(text)); };
  if (r.amplitude_share > 1e-3 * (1 + 1e-9))
    say(fmt::format("amplitude {:.2g} of the mean overlap (limit 1e-3): the contacts do not answer linearly",
                    r.amplitude_share));
  if (travel < 5 * r.wavelength * (1 - 0.05))
    say(fmt::format("the wave travels {:.1f} wavelengths between the receivers (5 are wanted): lengthen the packing",
                    travel / r.wavelength));
  if (length > 0 && r.setup.duration * r.speed > length - r.test.traces[r.far].distance)
    say("the test lasts until the wave comes back through the periodic cell: shorten --duration or lengthen the "
        "packing");
  const double f = r.setup.signal.frequency, group = r.branch ? r.branch->group_speed(f) : r.speed;
  if (r.setup.signal.duration() + r.test.traces[r.far].distance / group > 1.02 * r.setup.duration)
    say("the test ends before the signal has passed the far receiver, which speeds read from it suffer from: lengthen "
        "the packing, or take a higher --frequency");
  if (r.test.sliding > 0) say(fmt::format("{:.2g} % of the contacts slide", 100 * r.test.sliding));
}

int transmit_command(const TransmitFlags& flags) {
  check_figure(flags.figure), check_figure(flags.traces);
  const Snapshot work = load_packing(flags.packing);
  const auto begin = std::chrono::steady_clock::now();
  const int dimension = work.scene.dimension;
  TransmitReport r;
  r.name = flags.packing.input, r.title = work.scene.title, r.particles = work.state.grains.size();
  auto& setup = r.setup;
  setup.axis = axis_of(flags.axis, dimension - 1, dimension, "--axis");
  setup.motion = axis_of(flags.motion, setup.axis, dimension, "--motion");
  setup.signal = signal_of(flags);
  if (!flags.point.empty()) setup.point = Vec3{flags.point[0], flags.point[1], flags.point[2]};
  const Network net = linearise(work.scene, work.state);
  r.amplitude_share = flags.amplitude;
  setup.amplitude = flags.amplitude * mean_overlap(work.scene, work.state), setup.damping = flags.damping;
  const Layers layers = find_layers(work.state, setup.axis);
  r.branch = branch_of(work, net, setup.axis, setup.motion, layers.spacing);
  const double guess = r.branch ? r.branch->phase_speed(setup.signal.frequency) : std::nan("");
  r.speed = std::isnan(guess) ? affine_speed(net, work.state.cell.volume(), setup.axis, setup.motion) : guess;
  r.wavelength = r.speed / setup.signal.frequency;
  const StepInterval interval = step_interval(net);
  setup.dt = flags.step * interval.dt_safe;
  setup.every = std::max(1, static_cast<int>(std::floor(0.5 * interval.dt_safe / setup.dt)));
  const double length = work.state.cell.width(setup.axis);
  const bool periodic = work.state.cell.periodic[static_cast<std::size_t>(setup.axis)];
  setup.duration = flags.duration > 0 ? flags.duration : (periodic ? 0.54 : 0.95) * length / r.speed;
  Progress progress("wave", 1, "");
  setup.progress = [&](double share) { progress.update(share); };
  r.test = transmit(work.scene, work.state, setup);
  progress.finish();
  read_traces(r);
  warn(r, periodic ? length : 0);
  r.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  r.memory = 1024.0 * static_cast<double>(usage.ru_maxrss);
  for (const auto& line : r.warnings) fmt::print(stderr, "warning: {}\n", line);
  if (flags.packing.json)
    fmt::print("{}\n", json_of(r).dump(2));
  else
    fmt::print("{}", text_of(r));
  if (!flags.tables.empty()) write_tables(r, flags.tables);
  if (!flags.figure.empty()) save_figure(r.map ? map_figure(r) : trace_figure(r), flags.figure);
  if (!flags.traces.empty()) save_figure(trace_figure(r), flags.traces);
  return 0;
}

}  // namespace

void add_waves_transmit(CLI::App& waves, Action& action) {
  auto* sub = waves.add_subcommand("transmit", "send a wave through a packing, and read speeds and response");
  auto f = std::make_shared<TransmitFlags>();
  add_packing_options(*sub, f->packing);
  sub->add_option("--frequency", f->frequency, "of the signal [Hz]")->required()->check(positive_option);
  sub->add_option("--signal", f->signal, "sine: one period; ricker; sweep: from --frequency to --to (default: sine)")
      ->check(CLI::IsMember({"sine", "ricker", "sweep"}));
  sub->add_option("--to", f->last, "last frequency of a sweep [Hz]")->check(positive_option);
  sub->add_option("--axis", f->axis, "along which the wave travels (default: the last one)")
      ->check(CLI::IsMember({"x", "y", "z"}));
  sub->add_option("--motion", f->motion, "of the source: along the axis a P wave (default), across it an S wave")
      ->check(CLI::IsMember({"x", "y", "z"}));
  sub->add_option("--point", f->point, "source is the grain nearest to x y z [m], not the first layer")
      ->expected(3)
      ->check(finite_option);
  sub->add_option("--amplitude", f->amplitude, "of the source over the mean overlap (default: 1e-3)")
      ->check(positive_option);
  sub->add_option("--duration", f->duration, "of the test [s] (default: until the waves of both ways meet)")
      ->check(positive_option);
  sub->add_option("--step", f->step, "time step over the proved limit (default: 0.2)")
      ->check(finite_option)
      ->check(CLI::Range(1e-4, 1.0));
  sub->add_option("--damping", f->damping, "ratio of contact dashpots (default: 0)")
      ->check(finite_option)
      ->check(CLI::NonNegativeNumber);
  sub->add_option("--figure", f->figure, "draw the map of frequency and wave number (.svg, .png or .pdf)");
  sub->add_option("--traces", f->traces, "draw source and received signals (.svg, .png or .pdf)");
  sub->add_option("--tables", f->tables, "write traces, response and map (HDF5)");
  sub->callback([f, &action] { action = [f] { return transmit_command(*f); }; });
}

}  // namespace eg
