#include "measure/fabric.hpp"

#include "measure/stress.hpp"

namespace eg {

namespace {

template <class Weight>
Mat3 mean_direction(std::span<const ContactPoint> contacts, Weight weight) {
  Mat3 sum;
  double total = 0;
  for (const auto& c : contacts) {
    if (c.j == no_index) continue;
    const double w = weight(c);
    sum += w * outer(c.geometry.n, c.geometry.n);
    total += w;
  }
  if (total > 0) sum *= 1 / total;
  return sum;
}

}  // namespace

Mat3 fabric_tensor(std::span<const ContactPoint> contacts) {
  return mean_direction(contacts, [](const ContactPoint&) { return 1.0; });
}

Mat3 force_fabric_tensor(std::span<const ContactPoint> contacts) {
  return mean_direction(contacts, [](const ContactPoint& c) { return c.normal.force; });
}

StressParts stress_parts(std::span<const ContactPoint> contacts, double volume) {
  StressParts parts;
  for (const auto& c : contacts) parts.normal += outer(c.normal.force * c.geometry.n, c.branch);
  parts.normal *= 1 / volume;
  parts.tangential = stress(contacts, volume);
  parts.tangential -= parts.normal;
  return parts;
}

}  // namespace eg
