#include "app/timestep_report.hpp"

#include <fmt/ranges.h>

#include <cmath>

#include "base/progress.hpp"
#include "report/limit_chart.hpp"
#include "report/table.hpp"

namespace eg {
namespace {

/// The limit that ratios refer to: the middle of the interval.
double reference(const StepInterval& v) { return 0.5 * (v.dt_safe + v.dt_limit_upper); }

nlohmann::json number_or_null(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr); }

Table estimate_table(const TimestepReport& r) {
  Table t(
      {{"name", "estimate"}, {"dt", "step", "s"}, {"ratio", "over limit", "-"}, {"verdict"}, {"formula"}, {"source"}});
  for (const auto& e : r.estimates)
    t.add({e.name, e.dt, e.dt / reference(r.interval), verdict(e.dt, r.interval), e.formula, e.source});
  return t;
}

std::string damping_text(const DampingSpec& d) {
  std::vector<std::string> parts;
  if (d.local > 0) parts.push_back(fmt::format("local {:g}", d.local));
  if (d.mass > 0) parts.push_back(fmt::format("mass {:g} 1/s", d.mass));
  if (d.dashpots()) parts.push_back(fmt::format("dashpots {:g} normal, {:g} shear", d.normal_ratio, d.shear_ratio));
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// How far the lower end of the damped interval is proved: local damping is no linear term.
const char* damped_claim(const DampingSpec& d) { return d.local > 0 ? "stable, as measured" : "proved stable"; }

nlohmann::json damped_json(const TimestepReport& r) {
  if (!r.damped) return nullptr;
  const auto& d = r.damping;
  return {{"local", d.local},
          {"mass_per_s", d.mass},
          {"normal_ratio", d.normal_ratio},
          {"shear_ratio", d.shear_ratio},
          {"dt_safe", number_or_null(r.damped->dt_safe)},
          {"dt_limit_upper", number_or_null(r.damped->dt_limit_upper)},
          {"lower_end_proved", d.local == 0},
          {"methods", {{"lower", r.damped->method_lower}, {"upper", r.damped->method_upper}}}};
}

nlohmann::json probable_json(const StepInterval& v) {
  if (v.probable_error == 0) return nullptr;
  return {{"lambda_upper", v.lambda_probable}, {"dt", v.dt_probable}, {"probability_of_error", v.probable_error}};
}

nlohmann::json consistent_json(const TimestepReport& r) {
  if (!r.consistent) return nullptr;
  const auto& c = *r.consistent;
  const auto& g = c.spectrum;
  return {{"contacts", c.contacts},
          {"sliding", c.sliding},
          {"asymmetry", c.asymmetry},
          {"radius_lower", g.radius},
          {"radius_upper", c.radius_upper},
          {"largest_real", g.largest_real},
          {"flutter_pairs", g.flutter},
          {"flutter_rate_per_s", g.flutter_rate},
          {"flutter_frequency_Hz", g.flutter_frequency},
          {"negative_real", g.collapse},
          {"collapse_rate_per_s", g.collapse_rate},
          {"counts_are_complete", c.complete}};
}

}  // namespace

std::string verdict(double dt, const StepInterval& v) {
  if (dt > v.dt_limit_upper * (1 + 1e-12)) return "UNSTABLE";
  if (dt > v.dt_safe) return "within the interval";
  const double factor = v.dt_safe / dt;
  return factor < 1.5 ? "stable" : fmt::format("{:.1f} times too small", factor);
}

std::string text_of(const TimestepReport& r) {
  const auto& s = r.summary;
  const auto& v = r.interval;
  std::string out = fmt::format("{}{}\n", r.name, r.title.empty() ? "" : ": " + r.title);
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles", fmt::format("{} ({}D, {} rotation)", r.particles, r.dimension, r.rotation ? "with" : "without"));
  line("contacts",
       fmt::format("{}, coordination {:.2f}, at most {}", r.contacts, s.coordination_mean, s.coordination_max));
  line("mass", fmt::format("{:.4g} … {:.4g} kg", s.mass_min, s.mass_max));
  const auto consistent_lines = [&] {
    if (!r.consistent) return;
    const auto& c = *r.consistent;
    const auto& g = c.spectrum;
    const char* how_many = c.complete ? "" : " found at the ends of the spectrum";
    line("consistent tangent",
         fmt::format("{} of {} contacts slide; asymmetry {:.2e}", c.sliding, c.contacts, c.asymmetry));
    line("  spectral radius", fmt::format("{:.6g} 1/s² (proved: at most {:.6g}), 2/√ of it {:.6g} … {:.6g} s", g.radius,
                                          c.radius_upper, 2 / std::sqrt(c.radius_upper), 2 / std::sqrt(g.radius)));
    line("  complex pairs", g.flutter == 0 ? fmt::format("none{}", how_many)
                                           : fmt::format("{}{}; the fastest grows at {:.3g} 1/s, {:.4g} Hz (flutter)",
                                                         g.flutter, how_many, g.flutter_rate, g.flutter_frequency));
    line("  negative real", g.collapse == 0 ? fmt::format("none{}", how_many)
                                            : fmt::format("{}{}; the fastest grows at {:.3g} 1/s (collapse)",
                                                          g.collapse, how_many, g.collapse_rate));
  };
  const auto damped_lines = [&] {
    if (!r.damped || !std::isfinite(r.damped->dt_safe)) return;
    line("with damping",
         fmt::format("{:.6g} … {:.6g} s   ({})", r.damped->dt_safe, r.damped->dt_limit_upper, damping_text(r.damping)));
    line(fmt::format("  {}", damped_claim(r.damping)).c_str(), fmt::format("{:.8g} s", r.damped->dt_safe));
    line("  proved unstable above", fmt::format("{:.8g} s", r.damped->dt_limit_upper));
  };
  if (r.contacts == 0) {
    damped_lines();
    out += "\nNothing touches: no contact is stiff, so nothing limits the step here. Compress the packing first.\n";
    return out;
  }
  line("normal stiffness", fmt::format("{:.4g} … {:.4g} N/m", s.normal_min, s.normal_max));
  line("tangential stiffness", fmt::format("{:.4g} … {:.4g} N/m", s.tangential_min, s.tangential_max));
  if (!(v.lambda_upper > 0)) {
    out += "\nNo grain that touches can move, so nothing limits the step.\n";
    return out;
  }
  out += "\n";
  line("critical time step", fmt::format("{:.6g} … {:.6g} s   (width {:.2g} %)", v.dt_safe, v.dt_limit_upper,
                                         100 * (v.dt_limit_upper / v.dt_safe - 1)));
  line("  proved stable", fmt::format("{:.8g} s   by {}", v.dt_safe, v.method_upper));
  if (v.probable_error > 0)
    line("  stable, not proved", fmt::format("{:.8g} s   by a random test, wrong with a probability of at most {:.0e}",
                                             v.dt_probable, v.probable_error));
  line("  proved unstable above", fmt::format("{:.8g} s   by {}", v.dt_limit_upper, v.method_lower));
  if (r.bracket)
    line("  found by stepping", fmt::format("{:.6g} s runs, {:.6g} s blows up   ({} steps)", r.bracket->stable,
                                            r.bracket->unstable, r.bracket->steps));
  damped_lines();
  consistent_lines();
  line("limiting particle", fmt::format("id {}, radius {:.4g} m, {} contacts, {:.1f} % of the mode", r.limiting_id,
                                        r.limiting_radius, v.coordination, 100 * v.grain_share));
  line("grains in the mode", fmt::format("{:.1f} (participation number)", v.participation));
  out += fmt::format("\n{}", estimate_table(r).text());
  out +=
      fmt::format("\nstep = 2/ω_max for undamped motion with the contacts as they are; {}\n", duration_text(r.elapsed));
  return out;
}

nlohmann::json json_of(const TimestepReport& r) {
  const auto& v = r.interval;
  nlohmann::json j{
      {"input", r.name},
      {"title", r.title},
      {"dimension", r.dimension},
      {"rotation", r.rotation},
      {"particles", r.particles},
      {"contacts", r.contacts},
      {"lambda_lower", v.lambda_lower},
      {"lambda_upper", v.lambda_upper},
      {"dt_safe", number_or_null(v.dt_safe)},
      {"dt_limit_upper", number_or_null(v.dt_limit_upper)},
      {"probable", probable_json(v)},
      {"methods",
       {{"lower", v.method_lower}, {"upper", v.method_upper}, {"products", v.products}, {"residual", v.residual}}},
      {"damped", damped_json(r)},
      {"consistent", consistent_json(r)},
      {"participation", v.participation},
      {"elapsed_s", r.elapsed}};
  const auto& s = r.summary;
  j["mass_kg"] = {s.mass_min, s.mass_max};
  j["normal_stiffness_N_per_m"] = {s.normal_min, s.normal_max};
  j["tangential_stiffness_N_per_m"] = {s.tangential_min, s.tangential_max};
  j["limiting_particle"] = r.limiting_id == no_index ? nlohmann::json(nullptr)
                                                     : nlohmann::json{{"id", r.limiting_id},
                                                                      {"radius_m", r.limiting_radius},
                                                                      {"coordination", v.coordination},
                                                                      {"share", v.grain_share}};
  if (r.bracket)
    j["verification"] = {
        {"dt_stable", r.bracket->stable}, {"dt_unstable", r.bracket->unstable}, {"steps", r.bracket->steps}};
  j["estimates"] = estimate_table(r).json();
  return j;
}

Figure figure_of(const TimestepReport& r) {
  std::vector<LimitRow> rows;
  for (const auto& e : r.estimates) rows.push_back({e.name, e.dt / r.interval.dt_limit_upper});
  Figure figure = limit_chart(rows, r.interval.dt_safe / r.interval.dt_limit_upper);
  figure.title = r.title.empty() ? r.name : r.title;
  figure.subtitle = fmt::format("{} particles, {} contacts; exact limit {:.4g} … {:.4g} s, proved", r.particles,
                                r.contacts, r.interval.dt_safe, r.interval.dt_limit_upper);
  return figure;
}

}  // namespace eg
