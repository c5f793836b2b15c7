#include "measure/contact_network.hpp"

#include <algorithm>
#include <cmath>

namespace eg {

namespace {

Coordination count_ends(const std::vector<int>& ends) {
  Coordination result;
  result.grains = ends.size();
  long all = 0;
  for (const int n : ends) {
    all += n;
    result.isolated += n == 0;
    result.dangling += n == 1;
  }
  const auto bearing = result.grains - result.isolated - result.dangling;
  if (result.grains > 0) result.mean = static_cast<double>(all) / static_cast<double>(result.grains);
  if (bearing > 0)
    result.mechanical = static_cast<double>(all - static_cast<long>(result.dangling)) / static_cast<double>(bearing);
  return result;
}

void count_contacts(Coordination& result, std::span<const ContactPoint> contacts) {
  for (const auto& c : contacts) ++(c.j == no_index ? result.wall_contacts : result.contacts);
}

}  // namespace

std::vector<ContactPoint> touching_contacts(const Scene& scene, const State& state) {
  std::vector<ContactPoint> contacts;
  visit_contacts(scene, state, [&](const ContactPoint& contact) { contacts.push_back(contact); });
  return contacts;
}

std::vector<int> contacts_per_grain(std::size_t grains, std::span<const ContactPoint> contacts) {
  std::vector<int> ends(grains);
  for (const auto& c : contacts) {
    ++ends[c.i];
    if (c.j != no_index) ++ends[c.j];
  }
  return ends;
}

Coordination coordination(std::size_t grains, std::span<const ContactPoint> contacts) {
  Coordination result = count_ends(contacts_per_grain(grains, contacts));
  count_contacts(result, contacts);
  return result;
}

double rattler_share(const Coordination& c) {
  return c.grains > 0 ? static_cast<double>(c.isolated + c.dangling) / static_cast<double>(c.grains) : 0;
}

std::vector<bool> find_rattlers(std::size_t grains, std::span<const ContactPoint> contacts, int minimum) {
  std::vector<std::vector<Index>> touching(grains);
  for (const auto& c : contacts) {
    touching[c.i].push_back(c.j);
    if (c.j != no_index) touching[c.j].push_back(c.i);
  }
  std::vector<int> ends(grains);
  std::vector<bool> rattles(grains);
  std::vector<Index> loose;
  const auto test = [&](Index i) {
    if (rattles[i] || ends[i] >= minimum) return;
    rattles[i] = true;
    loose.push_back(i);
  };
  for (std::size_t i = 0; i < grains; ++i) ends[i] = static_cast<int>(touching[i].size());
  for (Index i = 0; i < grains; ++i) test(i);
  while (!loose.empty()) {
    const Index gone = loose.back();
    loose.pop_back();
    for (const Index j : touching[gone])
      if (j != no_index) --ends[j], test(j);
  }
  return rattles;
}

Coordination backbone(std::size_t grains, std::span<const ContactPoint> contacts, int minimum) {
  const auto rattles = find_rattlers(grains, contacts, minimum);
  std::vector<ContactPoint> bearing;
  for (const auto& c : contacts)
    if (!rattles[c.i] && (c.j == no_index || !rattles[c.j])) bearing.push_back(c);
  const auto ends = contacts_per_grain(grains, bearing);
  std::vector<int> kept;
  for (std::size_t i = 0; i < grains; ++i)
    if (!rattles[i]) kept.push_back(ends[i]);
  Coordination result = count_ends(kept);
  count_contacts(result, bearing);
  return result;
}

double sliding_fraction(std::span<const ContactPoint> contacts) {
  if (contacts.empty()) return 0;
  const auto sliding = std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.sliding(); });
  return static_cast<double>(sliding) / static_cast<double>(contacts.size());
}

double largest_overlap(const State& state, std::span<const ContactPoint> contacts) {
  double largest = 0;
  for (const auto& c : contacts) {
    const double ri = state.grains.radius(c.i), rj = c.j == no_index ? ri : state.grains.radius(c.j);
    largest = std::max(largest, c.geometry.overlap / (2 * std::min(ri, rj)));
  }
  return largest;
}

}  // namespace eg
