#include "dynamics/force_loop.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "contact/laws.hpp"
#include "dynamics/force_loop_of.hpp"

namespace eg {

Tally& Tally::operator+=(const Tally& b) {
  virial += b.virial;
  force_sum += b.force_sum, touching += b.touching;
  stiffness_sum += b.stiffness_sum, shear_work += b.shear_work, friction += b.friction, viscous += b.viscous;
  pulled += b.pulled, cut += b.cut;
  return *this;
}

std::unique_ptr<ForceLoop> make_force_loop(std::string_view law, bool frictionless, bool rotation) {
  std::unique_ptr<ForceLoop> loop;
  with_law(law, [&]<class Law>(Law) { loop = make_force_loop_of<Law>(frictionless, rotation); });
  if (!loop)
    throw InputError(
        fmt::format("contact.law = \"{}\" is not a law; known laws: {}", law, fmt::join(law_names(), ", ")));
  return loop;
}

void ForceWorkspace::clear() {
  if (!clean) std::fill(rows.begin(), rows.end(), Quad{});
  clean = true;
}

void prepare(ForceWorkspace& work, const State& state, const ForceLoop& loop) {
  make_schedule(work.schedule, state.grains.size(), Contacts::chunk, state.contacts.j, state.contacts.chunk_begin);
  work.stride = loop.has_moments() ? 2 : 1;
  work.rows.assign(work.schedule.rows() * work.stride, Quad{});
  work.clean = true;
  work.tally.resize(work.schedule.chunks()), work.kick_sums.resize(work.schedule.chunks());
  work.shift.resize(Cell::images);
}

ForceRow gather_row(const ForceWorkspace& work, std::size_t i) {
  ForceRow sum;
  const auto add = [&](std::size_t row) {
    sum.force += work.rows[row * work.stride].vec();
    if (work.stride == 2) sum.moment += work.rows[2 * row + 1].vec();
  };
  add(i);
  for (std::size_t e = 0; e < work.schedule.gather_row.size(); ++e)
    if (work.schedule.gather_grain[e] == i) add(work.schedule.gather_row[e]);
  return sum;
}

}  // namespace eg
