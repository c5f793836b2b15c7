// A held mean stress has one integral: axes that answer together must not each pull at it.
#include <gtest/gtest.h>

#include "boundary/cell_control.hpp"

namespace eg {
namespace {

TEST(MeanStressHold, AnIntegralGrowsByTheErrorOfTheMeanAlone) {
  State state;
  state.cell.periodic = {true, true, true};
  state.grains.position = {{0, 0, 0, 0.1}};
  state.grains.velocity = {{0, 0, 0, 1}};
  state.stiffness_sum = 9;
  state.virial(0, 0) = 0.5, state.virial(1, 1) = 0.7, state.virial(2, 2) = 1.8;  // a cell of volume 1: mean stress 1
  StageSpec stage;
  stage.control[2].value = 0.1;
  stage.control[0].kind = stage.control[1].kind = ComponentControl::Kind::free;
  stage.hold = {{CellCondition::Quantity::rate, {1, -1, 0, 0, 0, 0}, 0},
                {CellCondition::Quantity::stress, {1. / 3, 1. / 3, 1. / 3, 0, 0, 0}, 1.0}};
  CellControl(stage, state, 1).set_rate(state, 1e-3);
  for (const double integral : state.servo) EXPECT_EQ(integral, 0);
  EXPECT_NEAR(state.cell.rate(0, 0), 0.05, 1e-15);  // no error: the volume stays
  stage.hold[1].value = 1.01;
  CellControl(stage, state, 1).set_rate(state, 1e-3);
  EXPECT_GT(state.servo[1], 0);
  EXPECT_EQ(state.servo[0], 0);
  EXPECT_LT(state.cell.rate(0, 0), 0);
  EXPECT_EQ(state.cell.rate(0, 0), state.cell.rate(1, 1));
  EXPECT_EQ(state.cell.rate(2, 2), -0.1);
}

}  // namespace
}  // namespace eg
