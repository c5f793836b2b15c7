#include "dynamics/force_loop.hpp"

#include <fmt/ranges.h>

#include "base/error.hpp"
#include "contact/laws.hpp"
#include "dynamics/force_loop_of.hpp"

namespace eg {

Tally& Tally::operator+=(const Tally& b) {
  virial += b.virial;
  force_sum += b.force_sum, touching += b.touching;
  stiffness_sum += b.stiffness_sum, shear_work += b.shear_work, friction += b.friction, viscous += b.viscous;
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

void prepare(ForceWorkspace& work, const State& state) {
  make_schedule(work.schedule, state.grains.size(), Contacts::chunk, state.contacts.j, state.contacts.chunk_begin);
  work.rows.resize(work.schedule.rows());
  work.tally.resize(work.schedule.chunks());
  work.shift.resize(Cell::images);
}

}  // namespace eg
