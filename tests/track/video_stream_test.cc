// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "simulate/media/video_writer.h"
#include "track/video_frames.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 48, kFrames = 60;

class VideoStreamTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("video_stream_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Bright in the upper left quarter, and a little brighter in every frame.
  fs::path Film() const {
    const fs::path path = folder_ / "film.mp4";
    VideoWriter writer(path, kWidth, kHeight, 25);
    for (int k = 0; k < kFrames; ++k) {
      Image image(kWidth, kHeight);
      for (int v = 0; v < kHeight / 2; ++v) {
        std::fill_n(image.Row(v), 3 * kWidth / 2, static_cast<std::uint8_t>(120 + 2 * k));
      }
      writer.Write(std::move(image));
    }
    writer.Finish();
    return path;
  }

  static std::string BytesOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
};

// As a phone held upright writes it: the matrix of the track's header (ISO 14496-12, 8.3.2) asks
// for a quarter turn clockwise.
TEST_F(VideoStreamTest, TurnedFilmsAreUprightInColourLumaAndByNumber) {
  const fs::path path = Film();
  std::string bytes = BytesOf(path);
  const std::size_t header = bytes.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  const unsigned char turn[] = {0,    0,    0, 0, 0, 1, 0, 0, 0, 0, 0, 0,  // a, b, u
                                0xff, 0xff, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  bytes.replace(header + 44, sizeof turn, reinterpret_cast<const char*>(turn), sizeof turn);
  std::ofstream(path, std::ios::binary) << bytes;

  VideoSource in_colour(path), as_luma(path);
  VideoFrames by_number(path);
  ASSERT_EQ(internal::VideoStream(path).turns(), 1);
  ASSERT_EQ(std::pair(in_colour.width(), in_colour.height()), std::pair(kHeight, kWidth));
  ASSERT_EQ(std::pair(by_number.width(), by_number.height()), std::pair(kHeight, kWidth));
  Image colour, numbered;
  GrayImage luma;
  ASSERT_TRUE(in_colour.Read(&colour));
  ASSERT_TRUE(as_luma.Read(&luma));
  ASSERT_TRUE(by_number.Read(1, kHeight, kWidth, &numbered));
  for (const bool right : {false, true}) {
    for (const bool low : {false, true}) {
      const int u = right ? kHeight - 8 : 8, v = low ? kWidth - 8 : 8;
      const int gray = right && !low ? 120 : 0;  // the upper left quarter is the upper right now
      EXPECT_NEAR(colour.Row(v)[3 * u], gray, 6) << u << ' ' << v;
      EXPECT_NEAR(luma.Row(v)[u], gray, 6) << u << ' ' << v;
      EXPECT_NEAR(numbered.Row(v)[3 * u], gray, 6) << u << ' ' << v;
    }
  }
}

// A packet that cannot be decoded costs its frame. Decoders of several threads tell of it later,
// among those that they still hold when the file has ended.
TEST_F(VideoStreamTest, DamageNearTheEndCostsAFrameAtAnyNumberOfThreads) {
  const fs::path path = Film();
  std::string bytes = BytesOf(path);
  const std::size_t frame = bytes.size() - (bytes.size() - bytes.find("mdat")) / 5;
  for (std::size_t k = frame; k < frame + 60; ++k) bytes[k] = static_cast<char>(~bytes[k]);
  std::ofstream(path, std::ios::binary) << bytes;
  for (const int threads : {1, 2, 16}) {
    internal::VideoStream stream(path, threads);
    int frames = 0;
    while (stream.Next() != nullptr) ++frames;
    EXPECT_GE(frames, kFrames - 2) << threads;
    EXPECT_LT(frames, kFrames) << threads;  // else nothing was damaged
  }
}

// The packets of a film with other times, in units of a frame.
template <typename Times>
void Retime(const fs::path& from, const fs::path& to, const Times& times) {
  AVFormatContext* opened = nullptr;
  ASSERT_GE(avformat_open_input(&opened, from.c_str(), nullptr, nullptr), 0);
  const internal::AvInput input(opened);
  AVFormatContext* output = nullptr;
  ASSERT_GE(avformat_alloc_output_context2(&output, nullptr, nullptr, to.c_str()), 0);
  AVStream* stream = avformat_new_stream(output, nullptr);
  ASSERT_GE(avcodec_parameters_copy(stream->codecpar, input->streams[0]->codecpar), 0);
  stream->time_base = {1, 25};
  ASSERT_GE(avio_open(&output->pb, to.c_str(), AVIO_FLAG_WRITE), 0);
  ASSERT_GE(avformat_write_header(output, nullptr), 0);
  const internal::AvPacket packet(av_packet_alloc());
  for (int k = 0; av_read_frame(input.get(), packet.get()) >= 0; ++k) {
    packet->pts = packet->dts = times(k);
    packet->duration = times(k + 1) - times(k);
    av_packet_rescale_ts(packet.get(), {1, 25}, stream->time_base);
    ASSERT_GE(av_interleaved_write_frame(output, packet.get()), 0);
  }
  ASSERT_GE(av_write_trailer(output), 0);
  avio_closep(&output->pb);
  avformat_free_context(output);
}

TEST_F(VideoStreamTest, TheRateOfAFilmThatLacksFramesIsTheMean) {
  const fs::path path = Film(), gappy = folder_ / "gappy.mp4";
  EXPECT_EQ(internal::VideoStream(path).fps(), 25.0);
  EXPECT_EQ(internal::VideoStream(path).frame_count(), kFrames);
  // Every other frame of the second half was dropped.
  Retime(path, gappy, [](int k) { return k < kFrames / 2 ? k : 2 * k - kFrames / 2; });
  const internal::VideoStream stream(gappy);
  ASSERT_TRUE(stream.fps());
  EXPECT_NEAR(*stream.fps(), 25 / 1.5, 0.1);
  EXPECT_EQ(stream.frame_count(), kFrames);
}

}  // namespace
}  // namespace flocklift
