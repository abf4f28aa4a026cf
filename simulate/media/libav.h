// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Owners of libav's objects.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_
#define FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <memory>

namespace flocklift::internal {

template <typename T, void (*Free)(T**)>
struct LibavFreer {
  void operator()(T* p) const { Free(&p); }
};
template <typename T, void (*Free)(T**)>
using LibavOwner = std::unique_ptr<T, LibavFreer<T, Free>>;

using AvInput = LibavOwner<AVFormatContext, avformat_close_input>;
using AvCodec = LibavOwner<AVCodecContext, avcodec_free_context>;
using AvPacket = LibavOwner<AVPacket, av_packet_free>;
using AvFrame = LibavOwner<AVFrame, av_frame_free>;

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_
