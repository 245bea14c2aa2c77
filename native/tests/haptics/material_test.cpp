#include "riffler/haptics/material.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/error_of.hpp"

namespace riffler::haptics::material_test {
namespace {

TEST(Material, NamesTheObjectAndTheWrongField) {
  const auto message = [](auto change) {
    Material m;
    change(m);
    return test::error_of([&] { m.validate("fixture 2"); });
  };
  EXPECT_EQ(message([](auto&) {}), "");
  EXPECT_EQ(message([](auto& m) { m.stiffness = -1; }), "fixture 2: stiffness must not be negative");
  EXPECT_EQ(message([](auto& m) { m.removal_constant = NAN; }), "fixture 2: removal_constant must not be negative");
  EXPECT_EQ(message([](auto& m) { m.damping = -1; }), "fixture 2: damping must not be negative");
  EXPECT_EQ(message([](auto& m) { m.density = 0; }), "fixture 2: density must be positive");
}

TEST(Material, WeighsACubicCentimetreOfWaterOneGram) {
  EXPECT_DOUBLE_EQ(Material{}.mass(1000), 1);
}

}  // namespace
}  // namespace riffler::haptics::material_test
