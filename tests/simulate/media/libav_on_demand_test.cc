// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/libav_on_demand.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

void* IsLoaded(const char* library) { return dlopen(library, RTLD_NOLOAD | RTLD_LAZY); }

TEST(LibavOnDemand, IsLoadedByItsFirstFunction) {
  constexpr const char* kLibrary = "libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR);
  EXPECT_EQ(IsLoaded(kLibrary), nullptr);
  AVFrame* frame = av_frame_alloc();
  ASSERT_NE(frame, nullptr);
  EXPECT_NE(IsLoaded(kLibrary), nullptr);
  av_frame_free(&frame);
  EXPECT_EQ(frame, nullptr);
}

TEST(LibavOnDemand, EachLibraryIsSearched) {
  EXPECT_NE(avcodec_find_decoder(AV_CODEC_ID_MJPEG), nullptr);
  AVFormatContext* film = nullptr;
  EXPECT_LT(avformat_open_input(&film, "/nowhere.mp4", nullptr, nullptr), 0);
  EXPECT_NE(sws_getCoefficients(SWS_CS_ITU709), nullptr);
  EXPECT_THROW(internal::FindInLibav("av_fly"), std::runtime_error);
}

}  // namespace
}  // namespace flocklift
