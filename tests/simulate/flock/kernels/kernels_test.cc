// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/kernels.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "tests/simulate/flock/pair_sums.h"

namespace flocklift {
namespace {

// Every variant of this machine against the loop over pairs, byte for byte; all flocks, and
// samples.
template <typename Parameters>
void ExpectVariantsGiveTheSameBytes(const Parameters& p, bool headings = false) {
  int variants = 0;
  for (const NamedFlock& plain : ManyFlocks()) {
    const NamedFlock flock = headings ? Headings(plain) : plain;
    for (const std::uint32_t most : {0U, 9U}) {
      if (most > 0 && std::is_same_v<Parameters, ShapePairNumbers>) continue;  // takes no sample
      const SortedFlock<float> sorted(flock, Reach(p), most);
      const ByAnimal expected = sorted.Sum(p, "scalar");
      for (const KernelVariant* variant : kKernels) {
        if (!variant->supported()) continue;
        SCOPED_TRACE(variant->name + (" " + flock.name));
        ++variants;
        const ByAnimal actual = sorted.Sum(p, variant->name);
        EXPECT_EQ(actual.acceleration, expected.acceleration);
        EXPECT_EQ(actual.neighbours, expected.neighbours);
      }
    }
  }
  EXPECT_GE(variants, 1);
}

TEST(Kernels, Boids) {
  // The last on the lattice: neighbours exactly on the edge.
  for (const auto& p : {PlainRules(0.4, 1.05), PlainRules(2.1, 0.7), PlainRules(0.4, 1.05, 0.3),
                        PlainRules(1.0, 1.0)}) {
    ExpectVariantsGiveTheSameBytes(p);
  }
}

TEST(Kernels, BlindBoids) {
  for (const auto& p : {BlindRules(2.0), BlindRules(2.0, 0, 0.3), BlindRules(2.0, 0.3)}) {
    ExpectVariantsGiveTheSameBytes(p);
  }
}

TEST(Kernels, Zones) {
  for (const double taper : {0.0, 0.2}) {
    ExpectVariantsGiveTheSameBytes(ZoneParameters{0.3, 0.6, 1, 0.2, 3, 13, taper});
    ExpectVariantsGiveTheSameBytes(ZoneParameters{0.3, 10, 30, 0.2, 3, 13, taper});
  }
  // Several blocks of candidates with both lists in them; nobody attracts; everybody does.
  ExpectVariantsGiveTheSameBytes(ZoneParameters{0.7, 2, 5, 0.2, 3, 13, 0});
  ExpectVariantsGiveTheSameBytes(ZoneParameters{0.7, 2, 2, 0.2, 3, 13, 0});
  ExpectVariantsGiveTheSameBytes(ZoneParameters{0, 0, 3, 0.2, 3, 13, 0});
}

TEST(Kernels, Shape) {
  ShapeParameters p;
  p.r_ali = 0.7;
  ExpectVariantsGiveTheSameBytes(MakeShapePairNumbers(p, 0.3, 1.0));
  ExpectVariantsGiveTheSameBytes(MakeShapePairNumbers(p, 0.5, 0.2));
  ExpectVariantsGiveTheSameBytes(MakeShapePairNumbers(p, 0.3, 5.0));  // long lists
}

TEST(Kernels, Steer) {
  for (const auto& p : {SteerRules(1), SteerRules(1, 0.2), SteerRules(1, 0, 0.1)}) {
    ExpectVariantsGiveTheSameBytes(p, true);
  }
}

TEST(Kernels, AgreeWithDouble) {
  const NamedFlock flock = Headings(RandomFlock("", 1500, {6, 6, 6}, 12));
  const auto compare = [&](const auto& p, double size = 1) {
    const ByAnimal expected = SortedFlock<double>(flock, Reach(p)).Sum(p, "scalar");
    const ByAnimal actual = SortedFlock<float>(flock, Reach(p)).Sum(p, "");
    for (std::size_t k = 0; k < expected.acceleration.size(); ++k) {
      EXPECT_LT(Norm(actual.acceleration[k] - expected.acceleration[k]),
                1e-5 * (size + Norm(expected.acceleration[k])))
          << k;
      EXPECT_NEAR(actual.neighbours[k], expected.neighbours[k], 1e-4 * expected.neighbours[k]);
    }
  };
  compare(PlainRules(0.4, 1.05));
  compare(PlainRules(0.4, 1.05, 0.3));
  compare(BlindRules(2.0, 0.3, 0.3));
  compare(ZoneParameters{0.3, 0.6, 1, 0.2, 3, 13, 0});
  compare(ZoneParameters{0.3, 0.6, 1, 0.2, 3, 13, 0.2});
  compare(SteerRules(1, 0.2, 0.2), 28);  // the rules' weights: unit vectors of small sums
}

TEST(MoveKernel, EveryVariantOfThisMachineGivesTheSameBytes) {
  NamedFlock flock = RandomFlock("", 1037, {8, 8, 8}, 13);
  flock.velocity[5] = {};  // no direction to scale
  BoidsParameters<double> p = PlainRules(0.4, 1.05);
  p.s_min = 3;
  p.s_max = 6;
  const auto after = [&](const std::string& kernel) {
    World world;
    world.dt = 0.02;
    Engine engine(world, {AsSwarm(flock, p)}, {.threads = 1, .kernel = kernel});
    for (int step = 0; step < 5; ++step) engine.Step();
    return engine.State();
  };
  const FlockState expected = after("scalar");
  for (const KernelVariant* variant : kKernels) {
    if (!variant->supported()) continue;
    SCOPED_TRACE(variant->name);
    const FlockState actual = after(variant->name);
    EXPECT_EQ(actual.position, expected.position);
    EXPECT_EQ(actual.velocity, expected.velocity);
  }
}

TEST(Kernels, UnknownVariantIsRefused) { EXPECT_THROW(ChooseKernel("mmx"), std::invalid_argument); }

}  // namespace
}  // namespace flocklift
