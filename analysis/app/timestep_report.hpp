#pragma once
// What `eigengrain timestep` has to say, as text, JSON and figure.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "report/plot.hpp"
#include "timestep/consistent.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"
#include "timestep/verify.hpp"

namespace eg {

struct TimestepReport {
  std::string name, title;
  std::size_t particles = 0, contacts = 0;
  int dimension = 3;
  bool rotation = true;
  NetworkSummary summary;
  StepInterval interval;
  DampingSpec damping;                   ///< in force
  std::optional<DampedInterval> damped;  ///< when there is any
  std::optional<ConsistentReport> consistent;
  Index limiting_id = no_index;
  double limiting_radius = 0;  ///< [m]
  std::vector<Estimate> estimates;
  std::optional<StabilityBracket> bracket;
  double elapsed = 0;  ///< [s]
};

/// Stands beside each estimate: "stable", "UNSTABLE", "7.2 times too small"; against the interval of the limit.
std::string verdict(double dt, const StepInterval& interval);

std::string text_of(const TimestepReport& report);
nlohmann::json json_of(const TimestepReport& report);
Figure figure_of(const TimestepReport& report);

}  // namespace eg
