// What `eigengrain info --memory` counts, against what a run holds.
#include <gtest/gtest.h>
#include <malloc.h>

#include <map>
#include <memory>

#include "dynamics/engine.hpp"
#include "io/snapshot.hpp"
#include "search/neighbours.hpp"
#include "support/case_run.hpp"

#if defined(__SANITIZE_ADDRESS__)
extern "C" std::size_t
__sanitizer_get_current_allocated_bytes();  // g++ has the function, but not clang's header for it
#endif

namespace eg::test {
namespace {

/// Bytes in use.
double heap() {
#if defined(__SANITIZE_ADDRESS__)
  return static_cast<double>(__sanitizer_get_current_allocated_bytes());
#else
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
#endif
}

TEST(Memory, BytesCountedAreThoseHeld) {
  const CaseRun run("isotropic_compression",
                    "--set specimen.count=1000 --set 'stage[1].until={steps=3000}' --set 'stage[2].until={steps=10}'");
  ASSERT_TRUE(run.complete());
  const Snapshot snapshot = read_snapshot(run.file("final.h5"));
  const json info = json::parse(output("info --memory --json " + run.file("final.h5")));
  std::map<std::string, double> counted;
  for (const auto& row : info.at("memory")) counted[row.at("array")] = row.at("bytes");

  {
    State first = snapshot.state;  // threads take memory of their own when they are called for the first time
    const Engine engine(snapshot.scene, first);
    rebuild_neighbours(first, first.list.skin, first.list.contact_skin);
  }
  const double before = heap();
  State state = snapshot.state;
  const Engine engine(snapshot.scene, state);
  const double held = heap() - before;
  State other = state;
  auto scratch = std::make_unique<ListScratch>();
  rebuild_neighbours(other, other.list.skin, other.list.contact_skin, *scratch);
  const double with_scratch = heap();
  scratch.reset();
  const double upkeep = with_scratch - heap();

  EXPECT_NEAR(upkeep, counted.at("upkeep of the lists"), 0.05 * upkeep);
  EXPECT_NEAR(held + upkeep, counted.at("all"), 0.05 * counted.at("all"));
  EXPECT_GT(counted.at("bound of the step"), 0);
}

}  // namespace
}  // namespace eg::test
