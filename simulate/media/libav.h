// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Owners of libav's objects, and its silence.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_
#define FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_

#include <memory>

#include "simulate/media/libav_on_demand.h"

namespace flocklift::internal {

template <typename T, const OnDemand<void(T**)>& Free>
struct LibavFreer {
  void operator()(T* p) const { Free(&p); }
};
template <typename T, const OnDemand<void(T**)>& Free>
using LibavOwner = std::unique_ptr<T, LibavFreer<T, Free>>;

using AvInput = LibavOwner<AVFormatContext, avformat_close_input>;
using AvCodec = LibavOwner<AVCodecContext, avcodec_free_context>;
using AvPacket = LibavOwner<AVPacket, av_packet_free>;
using AvFrame = LibavOwner<AVFrame, av_frame_free>;

struct FreeScaler {
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
using AvScaler = std::unique_ptr<SwsContext, FreeScaler>;

// Its messages would stand beside our one line. To be called before anything else of libav.
inline void QuietLibav() {
  static const bool quiet = [] {
    av_log_set_level(AV_LOG_QUIET);
    return true;
  }();
  static_cast<void>(quiet);
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_MEDIA_LIBAV_H_
