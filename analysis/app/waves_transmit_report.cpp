#include "app/waves_transmit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/progress.hpp"
#include "io/hdf5_file.hpp"
#include "report/table.hpp"

namespace eg {
namespace {

Table arrival_table(const TransmitReport& r) {
  Table t({{"method"},
           {"time_s", "receiver to receiver", "s", 6},
           {"speed_m_per_s", "speed", "m/s", 6},
           {"source_time_s", "source to receiver", "s", 6},
           {"source_speed_m_per_s", "speed", "m/s", 6}});
  for (std::size_t k = 0; k < r.arrivals.size(); ++k)
    t.add(
        {r.arrivals[k].method, r.arrivals[k].time, r.arrivals[k].speed, r.from_source[k].time, r.from_source[k].speed});
  return t;
}

double group_speed(const TransmitReport& r) { return r.arrivals.back().speed; }

std::string beside(double measured, double exact) {
  return fmt::format("{:.6g} m/s, dispersion {:.6g} m/s ({:+.2f} %)", measured, exact, 100 * (measured / exact - 1));
}

}  // namespace

std::optional<TransmitReport::Ridge> TransmitReport::ridge_error() const {
  if (!branch || !map) return {};
  Ridge out;
  for (std::size_t row = 0; row < ridge.size(); ++row) {
    const double f = map->f_step * static_cast<double>(row), exact = branch->wave_number(f);
    const double bin = 2 * std::numbers::pi / (test.spacing * static_cast<double>(test.traces.size()));
    if (std::isnan(ridge[row]) || std::isnan(exact) || exact < 4 * bin) continue;
    if (!(branch->group_speed(f) * setup.duration > 0.5 * test.traces.back().distance)) continue;
    const double error = std::abs(ridge[row] / exact - 1);
    out.mean += error, out.worst = std::max(out.worst, error), ++out.rows;
  }
  if (out.rows == 0) return {};
  out.mean /= out.rows;
  return out;
}

std::string text_of(const TransmitReport& r) {
  const auto& s = r.setup;
  const auto& near = r.test.traces[r.near];
  const auto& far = r.test.traces[r.far];
  std::string out = fmt::format("{}{}\n", r.name, r.title.empty() ? "" : ": " + r.title);
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles", fmt::format("{}", r.particles));
  line("wave", fmt::format("along {}, motion along {}, {:.6g} Hz, length {:.4g} m", "xyz"[s.axis], "xyz"[s.motion],
                           s.signal.frequency, r.wavelength));
  line("source", fmt::format("{:.4g} m, {:.2g} of the mean overlap", s.amplitude, r.amplitude_share));
  line("receivers", fmt::format("{:.4g} m and {:.4g} m from it, {:.2f} wavelengths apart", near.distance, far.distance,
                                (far.distance - near.distance) / r.wavelength));
  line("test", fmt::format("{:.4g} s in {} steps of {:.4g} s{}", s.duration, r.test.steps, s.dt,
                           r.test.subtracted ? ", motion without source subtracted" : ""));
  out += fmt::format("\n{}\n", arrival_table(r).text());
  const double f = s.signal.frequency;
  if (r.branch && !std::isnan(r.branch->phase_speed(f))) {
    line("phase speed", beside(r.phase_speed, r.branch->phase_speed(f)));
    line("group speed", beside(group_speed(r), r.branch->group_speed(f)));
  } else {
    line("phase speed", fmt::format("{:.6g} m/s", r.phase_speed));
  }
  if (!std::isnan(r.cutoff))
    line("cut-off", fmt::format("{:.6g} Hz{}", r.cutoff,
                                r.branch ? fmt::format(", top of the branch {:.6g} Hz ({:+.2f} %)", r.branch->highest(),
                                                       100 * (r.cutoff / r.branch->highest() - 1))
                                         : ""));
  if (const auto ridge = r.ridge_error())
    line("ridge of the map", fmt::format("{} frequencies, {:.2f} % from the dispersion on average, {:.2f} % at most",
                                         ridge->rows, 100 * ridge->mean, 100 * ridge->worst));
  return out + fmt::format("\n{}, {:.0f} MB\n", duration_text(r.elapsed), 1e-6 * r.memory);
}

nlohmann::json json_of(const TransmitReport& r) {
  const auto number = [](double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr); };
  const double f = r.setup.signal.frequency;
  nlohmann::json j{{"input", r.name},
                   {"title", r.title},
                   {"particles", r.particles},
                   {"frequency_Hz", f},
                   {"wavelength_m", r.wavelength},
                   {"amplitude_m", r.setup.amplitude},
                   {"amplitude_over_overlap", r.amplitude_share},
                   {"receivers_m", {r.test.traces[r.near].distance, r.test.traces[r.far].distance}},
                   {"duration_s", r.setup.duration},
                   {"dt_s", r.setup.dt},
                   {"steps", r.test.steps},
                   {"subtracted", r.test.subtracted},
                   {"arrivals", arrival_table(r).json()},
                   {"phase_speed_m_per_s", number(r.phase_speed)},
                   {"group_speed_m_per_s", number(group_speed(r))},
                   {"cutoff_Hz", number(r.cutoff)},
                   {"warnings", r.warnings},
                   {"elapsed_s", r.elapsed},
                   {"memory_bytes", r.memory}};
  if (r.branch)
    j["dispersion"] = {{"phase_speed_m_per_s", number(r.branch->phase_speed(f))},
                       {"group_speed_m_per_s", number(r.branch->group_speed(f))},
                       {"highest_Hz", r.branch->highest()}};
  if (const auto ridge = r.ridge_error())
    j["ridge"] = {{"frequencies", ridge->rows}, {"mean_error", ridge->mean}, {"largest_error", ridge->worst}};
  return j;
}

void write_tables(const TransmitReport& r, const std::string& path) {
  Hdf5Writer file(path, path);
  std::vector<double> distance, u;
  for (const auto& trace : r.test.traces) {
    distance.push_back(trace.distance);
    u.insert(u.end(), trace.u.begin(), trace.u.end());
  }
  file.write("traces/interval", "s", {1}, std::vector{r.test.interval});
  file.write("traces/distance", "m", {distance.size()}, distance);
  file.write("traces/displacement", "m", {distance.size(), r.test.traces[0].u.size()}, u);
  file.write("response/frequency", "Hz", {r.frequencies.size()}, r.frequencies);
  file.write("response/ratio", "-", {r.response.size()}, r.response);
  if (r.map) {
    file.write("map/steps", "rad/m, Hz", {2}, std::vector{r.map->k_step, r.map->f_step});
    file.write("map/amplitude", "-", {r.map->rows, r.map->columns}, r.map->value);
    file.write("map/ridge", "rad/m", {r.ridge.size()}, r.ridge);
  }
  if (r.branch) {
    file.write("dispersion/k", "rad/m", {r.branch->k.size()}, r.branch->k);
    file.write("dispersion/frequency", "Hz", {r.branch->frequency.size()}, r.branch->frequency);
  }
  file.close();
}

Figure map_figure(const TransmitReport& r) {
  const WaveMap& m = *r.map;
  Figure figure;
  figure.title = r.title.empty() ? r.name : r.title;
  figure.subtitle = fmt::format("wave along {}, motion along {}; amplitude of each frequency over its largest",
                                "xyz"[r.setup.axis], "xyz"[r.setup.motion]);
  figure.x = {.title = "wave number [rad/m]", .low = 0, .high = std::numbers::pi / r.test.spacing};
  figure.y = {.title = "frequency [kHz]", .low = 0, .high = 1e-3 * m.f_step * static_cast<double>(m.rows - 1)};
  figure.map = {.x_low = -m.k_step / 2,
                .x_high = m.k_step * (static_cast<double>(m.columns) - 0.5),
                .y_low = -0.5e-3 * m.f_step,
                .y_high = 1e-3 * m.f_step * (static_cast<double>(m.rows) - 0.5),
                .columns = m.columns,
                .rows = m.rows,
                .value = m.value};
  figure.shades = Shades{.title = "amplitude [-]"};
  if (r.branch) {
    Series curve{.label = "dispersion", .x = r.branch->k};
    for (const double f : r.branch->frequency) curve.y.push_back(1e-3 * f);
    figure.series.push_back(curve);
  }
  return figure;
}

Figure trace_figure(const TransmitReport& r) {
  Figure figure;
  figure.title = r.title.empty() ? r.name : r.title;
  figure.subtitle = fmt::format("{:.6g} Hz, motion along {}", r.setup.signal.frequency, "xyz"[r.setup.motion]);
  figure.x = {.title = "time [ms]", .low = 0};
  figure.y = {.title = "displacement over the amplitude of the source [-]"};
  for (const std::size_t k : {std::size_t{0}, r.near, r.far}) {
    const auto& trace = r.test.traces[k];
    Series series{.label = k == 0 ? "source" : fmt::format("at {:.4g} m", trace.distance)};
    for (std::size_t n = 0; n < trace.u.size(); ++n) {
      series.x.push_back(1e3 * r.test.interval * static_cast<double>(n));
      series.y.push_back(trace.u[n] / r.setup.amplitude);
    }
    figure.series.push_back(series);
  }
  return figure;
}

}  // namespace eg
