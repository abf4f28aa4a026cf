// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/knowledge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "reconstruct/presets.h"

namespace flocklift {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Knowledge, NothingSeesNoScale) {
  EXPECT_THAT([] { CheckKnowledge({}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("does not see absolute scale")));
  Knowledge near_alone;
  near_alone.near = 10;
  EXPECT_THAT([&] { CheckKnowledge(near_alone); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--near with --far")));
  Knowledge size_unused;
  size_unused.wingspan = Uncertain{0.7, 0.1};
  size_unused.use_size = false;
  EXPECT_THROW(CheckKnowledge(size_unused), std::invalid_argument);
}

TEST(Knowledge, AnyOneFixesTheScale) {
  Knowledge speed;
  speed.speed = Uncertain{10, 1};
  EXPECT_NO_THROW(CheckKnowledge(speed));
  EXPECT_EQ(ScaleSources(speed), "speed");
  Knowledge range;
  range.near = 10;
  range.far = 50;
  EXPECT_NO_THROW(CheckKnowledge(range));
  EXPECT_EQ(ScaleSources(range), "near/far");
  Knowledge anchors;
  anchors.anchors.push_back({1, 1, {0, 0, 20}, 1});
  anchors.wingspan = Uncertain{0.7, 0.1};
  EXPECT_NO_THROW(CheckKnowledge(anchors));
  EXPECT_EQ(ScaleSources(anchors), "wingspan, anchors");
}

TEST(Knowledge, FaultsAreTold) {
  Knowledge crossed;
  crossed.near = 50;
  crossed.far = 10;
  EXPECT_THAT([&] { CheckKnowledge(crossed); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("near must be less than far")));
  Knowledge certain;
  certain.speed = Uncertain{10, 0};
  EXPECT_THAT([&] { CheckKnowledge(certain); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("deviation of speed")));
  Knowledge backwards;
  backwards.wingspan = Uncertain{-1, 1};
  EXPECT_THAT([&] { CheckKnowledge(backwards); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("wingspan must be")));
}

TEST(Presets, AreSane) {
  for (const SpeciesPreset& preset : SpeciesPresets()) {
    Knowledge knowledge;
    knowledge.speed = preset.speed;
    knowledge.wingspan = preset.wingspan;
    EXPECT_NO_THROW(CheckKnowledge(knowledge)) << preset.name;
    EXPECT_LT(preset.wingspan.sd, 0.1 * preset.wingspan.mean) << preset.name;
    EXPECT_EQ(PresetOf(preset.name).name, preset.name);
  }
  EXPECT_THAT([] { PresetOf("dodo"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("jackdaw, starling")));
}

}  // namespace
}  // namespace flocklift
