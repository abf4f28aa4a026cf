// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/track_editor.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "tools/stage.h"
#include "track/correct.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Kind = Correction::Kind;

constexpr int kFrames = 30;

// Animals 1 .. 4; 3 ends in frame 12 and 4 begins in frame 15.
Tracks Four() {
  Tracks tracks;
  tracks.fps = 30;
  for (Id id = 1; id <= 4; ++id) {
    Tracklet t{id, {}};
    for (int f = id == 4 ? 15 : 1; f <= (id == 3 ? 12 : kFrames); ++f) {
      Detection d;
      d.frame = f;
      d.box = Box::Around({10.0 * f, 100.0 * static_cast<double>(id)}, 8, 6);
      t.detections.push_back(d);
    }
    tracks.tracklets.push_back(t);
  }
  return tracks;
}

std::string TextOf(const Tracks& tracks) {
  std::ostringstream text;
  for (const Tracklet& t : tracks.tracklets) {
    for (const Detection& d : t.detections) {
      text << t.id << ' ' << d.frame << ' ' << d.box.left << ' ' << d.box.top << ' ' << d.box.width
           << ' ' << d.confidence << '\n';
    }
  }
  return text.str();
}

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Correction Of(const std::string& line) {
  std::istringstream stream(line + "\n");
  return ReadCorrections(stream, "a line").at(0);
}

class Editor : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("track_editor_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ / "corrections.txt";
  }
  void TearDown() override { fs::remove_all(folder_); }

  TrackEditor Open(const std::string& applied = "") const {
    return {Shared(Four()), Four().fps, kFrames, ReadCorrectionsFile(path_, applied)};
  }
  // What track --corrections makes of the file.
  std::string AsTheCommandDoes() const {
    Tracks tracks = Four();
    if (fs::exists(path_)) {
      ApplyCorrections(ReadCorrections(path_), path_.string(), kFrames, &tracks);
    }
    return TextOf(tracks);
  }

  fs::path folder_, path_;
};

TEST_F(Editor, SwapAndItsUndoChangeAndRestoreTracksAndFile) {
  TrackEditor editor = Open();
  editor.Apply(Of("swap 1 2 20"));
  EXPECT_EQ(ReadAll(path_), "swap 1 2 20\n");
  EXPECT_EQ(TextOf(editor.Result()), AsTheCommandDoes());
  EXPECT_NE(TextOf(editor.Result()), TextOf(Four()));
  EXPECT_EQ(editor.Result().tracklets[0].detections[19].box.Center().y, 200);
  ASSERT_TRUE(editor.Undo());
  EXPECT_EQ(TextOf(editor.Result()), TextOf(Four()));
  EXPECT_FALSE(fs::exists(path_));
  ASSERT_TRUE(editor.Redo());
  EXPECT_EQ(ReadAll(path_), "swap 1 2 20\n");
  EXPECT_FALSE(editor.Redo());
  ASSERT_TRUE(editor.Undo());
  EXPECT_FALSE(editor.Undo());
}

TEST_F(Editor, EveryKindDoesWhatTheCommandDoes) {
  TrackEditor editor = Open();
  const std::vector<Correction> corrections = {Of("split 2 9"),
                                               Of("join 3 4"),
                                               Of("add 5 12.5 99.25"),
                                               Of("delete 1 3 4"),
                                               Of("pin 6 9 0.3333333333 20"),
                                               Of("delete 5"),
                                               Of("split 1 20")};
  for (const Correction& c : corrections) {
    editor.Apply(c);
    EXPECT_EQ(TextOf(editor.Result()), AsTheCommandDoes()) << LineOf(c);
  }
  // The last split's animal is new: that which was deleted keeps its id for itself.
  EXPECT_EQ(editor.Result().tracklets.back().id, 7);
  // And back, one by one, and forth again.
  while (editor.Undo()) EXPECT_EQ(TextOf(editor.Result()), AsTheCommandDoes());
  EXPECT_EQ(TextOf(editor.Result()), TextOf(Four()));
  EXPECT_EQ(editor.redo_count(), corrections.size());
  while (editor.Redo()) EXPECT_EQ(TextOf(editor.Result()), AsTheCommandDoes());
  EXPECT_EQ(editor.Lines().size(), corrections.size());
}

TEST_F(Editor, RandomEditsAndUndosAgreeWithTheCommand) {
  Rng rng(17, 3);
  TrackEditor editor = Open();
  int applied = 0;
  for (int k = 0; k < 120; ++k) {
    const double what = rng.Uniform(0, 1);
    if (what < 0.2) {
      editor.Undo();
    } else if (what < 0.3) {
      editor.Redo();
    } else {
      Correction c;
      c.kind = static_cast<Kind>(static_cast<int>(rng.Uniform(0, 6)));
      c.id = static_cast<Id>(rng.Uniform(1, 8));
      c.other_id = static_cast<Id>(rng.Uniform(1, 8));
      c.first_frame = static_cast<int>(rng.Uniform(1, kFrames + 1));
      c.last_frame = std::min(kFrames, c.first_frame + 3);
      c.point = {rng.Uniform(0, 300), rng.Uniform(0, 300)};
      if (c.id == c.other_id && (c.kind == Kind::kSwap || c.kind == Kind::kJoin)) continue;
      try {
        editor.Apply(c);
        ++applied;
      } catch (const InputError&) {
        // did not fit; nothing may have changed
      }
    }
    ASSERT_EQ(TextOf(editor.Result()), AsTheCommandDoes());
  }
  EXPECT_GT(applied, 20);
}

TEST_F(Editor, ACorrectionThatDoesNotFitChangesNothing) {
  TrackEditor editor = Open();
  editor.Apply(Of("split 2 9"));
  const std::string before = TextOf(editor.Result());
  EXPECT_THROW(editor.Apply(Of("swap 1 99 2")), InputError);
  EXPECT_THROW(editor.Apply(Of("join 1 2")), InputError);
  EXPECT_THROW(editor.Apply(Of("split 1 99")), InputError);
  EXPECT_EQ(TextOf(editor.Result()), before);
  EXPECT_EQ(ReadAll(path_), "split 2 9\n");
}

TEST_F(Editor, GoesOnFromAFileThatTheTracksHaveNotSeen) {
  std::ofstream(path_) << "# by hand\nswap 1 2 20\n";
  TrackEditor editor = Open();
  EXPECT_EQ(TextOf(editor.Result()), AsTheCommandDoes());
  EXPECT_EQ(editor.Lines(), (std::vector<std::string>{"swap 1 2 20"}));
}

TEST_F(Editor, KeepsWhatTheTracksHaveSeen) {
  const std::string applied = "# seen\nswap 1 2 20\n";
  std::ofstream(path_) << applied << "split 2 9\n";
  TrackEditor editor = Open(Sha256OfText(applied));
  EXPECT_EQ(editor.Lines(), (std::vector<std::string>{"split 2 9"}));
  editor.Undo();
  EXPECT_EQ(ReadAll(path_), applied);
  EXPECT_FALSE(editor.Undo());
  EXPECT_EQ(TextOf(editor.Result()), TextOf(Four()));
  // A file that is not the one that the tracks have seen cannot be gone on from.
  EXPECT_THROW(ReadCorrectionsFile(path_, Sha256OfText("other")), InputError);
}

TEST_F(Editor, TouchesOnlyWhatACorrectionNames) {
  TrackEditor editor = Open();
  editor.Apply(Of("split 2 9"));
  for (const Id id : editor.touched()) EXPECT_TRUE(id == 2 || id == 5) << id;
}

}  // namespace
}  // namespace flocklift
