#include "measure/force_network.hpp"

#include <algorithm>
#include <vector>

#include "measure/stress.hpp"
#include "measure/tensor.hpp"

namespace eg {

ForceNetwork force_network(std::span<const ContactPoint> contacts, int dimension) {
  ForceNetwork result;
  if (contacts.empty()) return result;
  double mobilised = 0, rubbing = 0;
  for (const auto& c : contacts) {
    result.mean_force += c.normal.force;
    result.largest_force = std::max(result.largest_force, c.normal.force);
    if (c.limit > 0) mobilised += norm(c.shear) / c.limit, ++rubbing;
  }
  const auto count = static_cast<double>(contacts.size());
  result.mean_force /= count;
  if (rubbing > 0) result.mobilised_friction = mobilised / rubbing;

  std::vector<ContactPoint> strong;
  for (const auto& c : contacts)
    if (is_strong(c, result.mean_force)) strong.push_back(c);
  result.strong_contacts = static_cast<double>(strong.size()) / count;
  const Mat3 part = stress(strong, 1), whole = stress(contacts, 1);
  const double mean = mean_value(whole, dimension);
  if (mean != 0) result.strong_mean_share = mean_value(part, dimension) / mean;
  result.strong_deviator_share = deviator_share(part, whole, dimension);
  return result;
}

}  // namespace eg
